// SPDX-License-Identifier: MIT
#include "datasets/registration/surface_cloud.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "core/point_tree.h"
#include "core/sampling.h"
#include "datasets/geometry/surface_patches.h"

namespace raymoval::registration {
namespace {

constexpr float kNearest = 0.5F, kFarthest = 60.0F;  // metres
constexpr float kNearestShare = 0.25F;               // of the median range

float median_range_of(const Scan& scan) {
  std::vector<float> ranges;
  ranges.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) ranges.push_back(point.norm());
  return ranges.empty() ? 0.0F : median_in_place(ranges);
}

Eigen::Vector3d mean_of(std::span<const PlacedPoint> points) {
  Eigen::Matrix<std::int64_t, 3, 1> sum = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
  for (const PlacedPoint& p : points) sum += p.at.cast<std::int64_t>();
  return 0.001 * sum.cast<double>() / static_cast<double>(points.size());
}

std::vector<SurfacePoint> surface_points(const Scan& scan, float nearest) {
  std::vector<SurfacePoint> surfaces;
  for_each_patch(scan, nearest, kFarthest,
                 [&](const SurfacePatch& patch, std::span<const PlacedPoint> points) {
                   for_each_cell(points, kPlacedBits, [&](std::span<const PlacedPoint> cell) {
                     const Eigen::Vector3d mean = mean_of(cell);
                     const double above = patch.normal.dot(mean - patch.mean);
                     surfaces.push_back(
                         {(mean - above * patch.normal).cast<float>(), patch.normal.cast<float>()});
                   });
                 });
  return surfaces;
}

}  // namespace

struct SurfaceCloud::Tree {
  explicit Tree(std::vector<SurfacePoint> of) : points(std::move(of)), index(points) {}
  std::vector<SurfacePoint> points;
  PointTree<SurfacePoint> index;
};

SurfaceCloud::SurfaceCloud(const Scan& scan) {
  const float median = median_range_of(scan);
  median_range_ = median;
  tree_ = std::make_unique<Tree>(surface_points(scan, std::max(kNearest, kNearestShare * median)));
}

SurfaceCloud::~SurfaceCloud() = default;
SurfaceCloud::SurfaceCloud(SurfaceCloud&&) noexcept = default;

const std::vector<SurfacePoint>& SurfaceCloud::points() const {
  return tree_->points;
}

const SurfacePoint* SurfaceCloud::nearest(const Eigen::Vector3f& position, float reach) const {
  return tree_->index.nearest(position.data(), reach);
}

}  // namespace raymoval::registration
