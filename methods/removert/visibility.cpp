// SPDX-License-Identifier: MIT
#include "methods/removert/visibility.h"

#include <atomic>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace raymoval::removert_method {
namespace {

/// Upper bound of the relative error of ranges in single precision.
constexpr float kRangeSlack = 1e-5F;

/// Enlargement of the bounds of a ball for rounding, pixels and radians.
constexpr float kPixelSlack = 0.02F;

constexpr float kPi = static_cast<float>(std::numbers::pi);

/// An upper bound of the arc sine of 0 <= s <= 1.
float arc_sine_bound(float s) {
  return s * (1.0F + 0.5708F * s * s);
}

int rounded(float raw) {
  return static_cast<int>(std::floor(raw + 0.5F));
}

/// Largest limit in rows [top, bottom] and columns [left, right], which may cross the seam.
float bound_around(const MaximumPyramid& pyramid, int columns, int top, int bottom, int left,
                   int right) {
  if (right - left >= columns - 1) return pyramid.bound(top, bottom, 0, columns - 1);
  if (left < 0) {
    return std::max(pyramid.bound(top, bottom, left + columns, columns - 1),
                    pyramid.bound(top, bottom, 0, std::max(right, 0)));
  }
  if (right >= columns) {
    return std::max(pyramid.bound(top, bottom, std::min(left, columns - 1), columns - 1),
                    pyramid.bound(top, bottom, 0, right - columns));
  }
  return pyramid.bound(top, bottom, left, right);
}

/// Columns that points within `half_width` radians of `azimuth` can fall into.
std::pair<int, int> columns_around(const PixelGrid& grid, float azimuth, float half_width) {
  const std::pair<int, int> all{0, grid.columns() - 1};
  if (half_width >= kPi) return all;
  const float middle = 0.5F * static_cast<float>(grid.columns());
  const float scale = static_cast<float>(grid.column_scale());
  const int left = rounded(middle + (azimuth - half_width) * scale - kPixelSlack);
  const int right = rounded(middle + (azimuth + half_width) * scale + kPixelSlack);
  // Without wrapping, the half column before the seam is rounded into the last column.
  if (grid.full_circle()) return {left == 0 && !grid.wraps() ? -1 : left, right};
  // Beyond the seam, points are at the other side of the image.
  if (std::abs(azimuth) + half_width >= kPi - 0.01F) return all;
  return {std::clamp(left, 0, grid.columns() - 1), std::clamp(right, 0, grid.columns() - 1)};
}

/// An upper bound of the limits in the pixels that points of a ball can fall into. It is -1 if they
/// cannot fall into any pixel or are all too far.
float limit_around(const PixelGrid& grid, const MaximumPyramid& limits,
                   const Eigen::Vector3f& centre, float radius) {
  const float distance = centre.norm();
  const float nearest = (distance - radius) * (1.0F - kRangeSlack);
  if (nearest >= limits.top()) return -1.0F;
  if (nearest <= 0.0F) return limits.top();
  const float flat = centre.head<2>().norm();
  const float azimuth = std::atan2(centre.y(), centre.x());
  const float elevation = std::atan2(centre.z(), flat);
  const float half_height = arc_sine_bound(radius / distance);
  const float scale = static_cast<float>(grid.row_scale());
  const float middle = 0.5F * static_cast<float>(grid.rows());
  const float top = middle - (elevation + half_height) * scale - kPixelSlack;
  const float bottom = middle - (elevation - half_height) * scale + kPixelSlack;
  const int last = grid.rows() - 1;
  if (!grid.clamps() && (bottom < 0.0F || top > static_cast<float>(last + 1))) return -1.0F;
  const float half_width = flat > radius ? arc_sine_bound(radius / flat) : kPi;
  const auto [left, right] = columns_around(grid, azimuth, half_width);
  const float limit = bound_around(limits, grid.columns(), std::clamp(rounded(top), 0, last),
                                   std::clamp(rounded(bottom), 0, last), left, right);
  return nearest < limit ? limit : -1.0F;
}

}  // namespace

/// A scan's image with the transformation into its frame, in both precisions.
struct VisibilityPass::View {
  View(const ScanImage& image, const Pose& T_image_world)
      : scan(image),
        pose(T_image_world),
        rotation(T_image_world.linear().cast<float>()),
        limits(&image.limit_pyramid) {}
  [[nodiscard]] float limit_around_ball(const Ball& ball) const {
    return limit_around(scan.grid, *limits, (pose * ball.centre).cast<float>(), ball.radius);
  }
  /// From now on, points behind the map points that were already found are skipped too.
  void hide_behind(const std::vector<Nearest>& pixels) {
    std::vector<float> reach = scan.limit;
    for (std::size_t u = 0; u < reach.size(); ++u) {
      reach[u] = std::min(reach[u], static_cast<float>(pixels[u].range) * (1.0F + kRangeSlack));
    }
    hidden.emplace(reach, scan.grid.rows(), scan.grid.columns());
    limits = &*hidden;
  }

  const ScanImage& scan;
  Pose pose;
  Eigen::Matrix3f rotation;
  const MaximumPyramid* limits;
  std::optional<MaximumPyramid> hidden;
};

VisibilityPass::VisibilityPass(const MapPoints& map, const Parameters& parameters,
                               Candidates candidates)
    : map_(map),
      parameters_(parameters),
      candidates_(candidates),
      flagged_(map.size(), 0),
      images_([] { return std::make_unique<Image>(); }) {}

void VisibilityPass::show(const ScanImage& scan, const Pose& T_image_world) {
  View view(scan, T_image_world);
  images_.with_one([&](Image& image) {
    image.pixels.resize(static_cast<std::size_t>(scan.grid.size()), kEmpty);
    std::size_t looked_at = 0;
    for (const std::size_t g : order_of_groups(T_image_world)) {
      const BlockGroup& group = map_.groups[g];
      if (view.limit_around_ball(group.ball) < 0.0F) continue;
      for (std::size_t b = group.begin; b < group.end; ++b) {
        const Block& block = map_.blocks[b];
        const float limit = view.limit_around_ball(block.ball);
        if (limit < 0.0F) continue;
        look_at_block(view, block, limit, image);
        looked_at += block.end - block.begin;
      }
      if (candidates_ == Candidates::kAll && looked_at > 2 * image.pixels.size()) {
        view.hide_behind(image.pixels);
        looked_at = 0;
      }
    }
    flag(scan, image);
  });
}

/// The map's own order, or near groups first if near points can hide far ones.
std::vector<std::size_t> VisibilityPass::order_of_groups(const Pose& T_image_world) const {
  std::vector<std::size_t> order(map_.groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (candidates_ == Candidates::kInFront) return order;
  std::vector<double> distances;
  distances.reserve(order.size());
  for (const BlockGroup& group : map_.groups) {
    distances.push_back((T_image_world * group.ball.centre).norm());
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(distances[a], a) < std::pair(distances[b], b);
  });
  return order;
}

void VisibilityPass::look_at_block(const View& view, const Block& block, float limit,
                                   Image& image) const {
  const Eigen::Vector3f centre = (view.pose * block.centre).cast<float>();
  const Eigen::Matrix3f& r = view.rotation;
  PointBatch batch;
  for (std::size_t from = block.begin; from < block.end; from += PointBatch::kSize) {
    const int count = static_cast<int>(std::min<std::size_t>(PointBatch::kSize, block.end - from));
    const float *x = &map_.x[from], *y = &map_.y[from], *z = &map_.z[from];
    for (int i = 0; i < count; ++i) {
      batch.x[i] = r(0, 0) * x[i] + r(0, 1) * y[i] + r(0, 2) * z[i] + centre.x();
      batch.y[i] = r(1, 0) * x[i] + r(1, 1) * y[i] + r(1, 2) * z[i] + centre.y();
      batch.z[i] = r(2, 0) * x[i] + r(2, 1) * y[i] + r(2, 2) * z[i] + centre.z();
    }
    batch.project(view.scan.grid, count);
    for (int i = 0; i < count; ++i) {
      const float nearest = batch.range[i] * (1.0F - kRangeSlack);
      if (nearest >= limit) continue;
      const int pixel = view.scan.grid.fast_pixel(batch.row[i], batch.column[i]);
      if (pixel == kOutside) continue;
      if (pixel >= 0) {
        const auto u = static_cast<std::size_t>(pixel);
        if (nearest >= view.scan.limit[u] || nearest > image.pixels[u].range) continue;
      }
      const std::size_t point = from + static_cast<std::size_t>(i);
      take_if_nearest(view, view.pose * map_.position(block, point), point, image);
    }
  }
}

void VisibilityPass::take_if_nearest(const View& view, const Eigen::Vector3d& point, std::size_t id,
                                     Image& image) {
  const int pixel = view.scan.grid.pixel_of(point);
  if (pixel == kOutside) return;
  const auto u = static_cast<std::size_t>(pixel);
  const double range = point.norm();
  if (!(range < view.scan.limit[u])) return;
  // Of two points at the same range, the first in the map's order is the nearest.
  if (std::pair(range, id) >= std::pair(image.pixels[u].range, image.pixels[u].point)) return;
  if (image.pixels[u].point == kEmpty.point) image.touched.push_back(pixel);
  image.pixels[u] = {range, id};
}

/// Section 1 of the method: p_M(u) is dynamic iff diff(u) > tau(u).
void VisibilityPass::flag(const ScanImage& scan, Image& image) {
  for (const int pixel : image.touched) {
    const auto u = static_cast<std::size_t>(pixel);
    const Nearest nearest = image.pixels[u];
    image.pixels[u] = kEmpty;
    double difference = static_cast<double>(scan.nearest[u]) - nearest.range;
    if (parameters_.difference == DifferenceRule::kAbsolute) difference = std::abs(difference);
    const bool dynamic =
        difference > static_cast<double>(threshold(scan.nearest[u], parameters_)) &&
        difference < parameters_.diff_upper;
    std::atomic_ref<std::uint8_t> flagged(flagged_[nearest.point]);
    if (dynamic) flagged.store(1, std::memory_order_relaxed);
  }
  image.touched.clear();
}

}  // namespace raymoval::removert_method
