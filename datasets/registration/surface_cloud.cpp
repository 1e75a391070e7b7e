// SPDX-License-Identifier: MIT
#include "datasets/registration/surface_cloud.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/morton.h"
#include "datasets/registration/point_table.h"

namespace raymoval::registration {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Sum = Eigen::Matrix<std::int64_t, 3, 1>;
using SquareSum = Eigen::Matrix<std::int64_t, 3, 3>;

constexpr int kPointBits = 8;                        // Cells of 256 mm, one surface point each.
constexpr int kSmallestBits = 9, kLargestBits = 12;  // Planes in cells of 512 to 4,096 mm.
constexpr float kNearest = 0.5F, kFarthest = 60.0F;  // metres
constexpr float kNearestShare = 0.25F;               // of the median range
constexpr std::size_t kFewest = 8;                   // points of a plane
constexpr double kThickness = 0.06;                  // metres, standard deviation across a plane
constexpr double kFlatness = 5.0;    // Least ratio of the short side of a plane to its thickness.
constexpr double kShortSide = 0.05;  // metres, standard deviation along the short side
constexpr double kMetre = 0.001;     // metres in a millimetre

/// A point in whole millimetres with the Morton code of its cell.
struct CellPoint {
  std::uint64_t code = 0;
  Eigen::Vector3i at;
};
using CellPoints = std::span<const CellPoint>;

std::vector<CellPoint> sorted_cells(const Scan& scan, float nearest) {
  constexpr int kBias = 1 << 17;  // 131 m: no coordinate is negative.
  std::vector<CellPoint> sorted;
  sorted.reserve(scan.size());
  for (const Vector3f& point : scan.points) {
    const float range = point.norm();
    if (!(range >= nearest && range <= kFarthest)) continue;
    CellPoint p;
    p.at = (point.cast<double>() / kMetre).array().round().cast<int>();
    for (int axis = 0; axis < 3; ++axis) {
      p.code |= spread_bits(static_cast<std::uint64_t>(p.at[axis] + kBias) >> kPointBits) << axis;
    }
    sorted.push_back(p);
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const CellPoint& a, const CellPoint& b) { return a.code < b.code; });
  return sorted;
}

/// Calls `visit` with the points of each cell of 2^bits millimetres.
template <class Visit>
void for_each_cell(CellPoints points, int bits, Visit&& visit) {
  const int shift = 3 * (bits - kPointBits);
  for (std::size_t first = 0, i = 1; i <= points.size(); ++i) {
    if (i < points.size() && points[i].code >> shift == points[first].code >> shift) continue;
    visit(points.subspan(first, i - first));
    first = i;
  }
}

Vector3d mean_of(CellPoints points) {
  Sum sum = Sum::Zero();
  for (const CellPoint& p : points) sum += p.at.cast<std::int64_t>();
  return kMetre * sum.cast<double>() / static_cast<double>(points.size());
}

struct Plane {
  Vector3d mean, normal;
};

/// @return whether the points lie on a plane
bool fit_plane(CellPoints points, Plane& plane) {
  const Vector3d mean = mean_of(points);
  const Eigen::Vector3i origin = (mean / kMetre).array().round().cast<int>();
  Sum first = Sum::Zero();
  SquareSum second = SquareSum::Zero();
  for (const CellPoint& point : points) {
    const Sum p = (point.at - origin).cast<std::int64_t>();
    first += p;
    second += p * p.transpose();
  }
  const auto count = static_cast<double>(points.size());
  const Vector3d offset = first.cast<double>() / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect((second.cast<double>() / count - offset * offset.transpose()) *
                       (kMetre * kMetre));
  const Vector3d spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (spread[0] > kThickness || spread[1] < std::max(kShortSide, kFlatness * spread[0])) {
    return false;
  }
  plane = {mean, solver.eigenvectors().col(0)};
  if (plane.normal.dot(mean) > 0.0) plane.normal = -plane.normal;
  return true;
}

void add_surfaces(CellPoints points, int bits, std::vector<SurfacePoint>& surfaces) {
  if (points.size() < kFewest) return;
  Plane plane;
  if (fit_plane(points, plane)) {
    for_each_cell(points, kPointBits, [&](CellPoints cell) {
      const Vector3d mean = mean_of(cell);
      const Vector3d on_plane = mean - plane.normal.dot(mean - plane.mean) * plane.normal;
      surfaces.push_back({on_plane.cast<float>(), plane.normal.cast<float>()});
    });
  } else if (bits > kSmallestBits) {
    for_each_cell(points, bits - 1,
                  [&](CellPoints cell) { add_surfaces(cell, bits - 1, surfaces); });
  }
}

float median_range_of(const Scan& scan) {
  if (scan.points.empty()) return 0.0F;
  std::vector<float> ranges;
  ranges.reserve(scan.size());
  for (const Vector3f& point : scan.points) ranges.push_back(point.norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

}  // namespace

struct SurfaceCloud::Tree {
  explicit Tree(std::vector<SurfacePoint> of)
      : points(std::move(of)),
        table{points},
        index(3, table, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    index.buildIndex();
  }
  std::vector<SurfacePoint> points;
  PointTable<SurfacePoint> table;
  PointKdTree<SurfacePoint> index;
};

SurfaceCloud::SurfaceCloud(const Scan& scan) {
  const float median = median_range_of(scan);
  median_range_ = median;
  const std::vector<CellPoint> cells =
      sorted_cells(scan, std::max(kNearest, kNearestShare * median));
  std::vector<SurfacePoint> surfaces;
  for_each_cell(cells, kLargestBits,
                [&](CellPoints cell) { add_surfaces(cell, kLargestBits, surfaces); });
  tree_ = std::make_unique<Tree>(std::move(surfaces));
}

SurfaceCloud::~SurfaceCloud() = default;
SurfaceCloud::SurfaceCloud(SurfaceCloud&&) noexcept = default;

const std::vector<SurfacePoint>& SurfaceCloud::points() const {
  return tree_->points;
}

const SurfacePoint* SurfaceCloud::nearest(const Vector3f& position, float reach) const {
  std::uint32_t number = 0;
  float square = 0.0F;
  nanoflann::KNNResultSet<float, std::uint32_t> found(1);
  found.init(&number, &square);
  square = reach * reach;  // Of the set so far: nothing farther away is looked for.
  tree_->index.findNeighbors(found, position.data(), nanoflann::SearchParams());
  return found.size() == 0 ? nullptr : &tree_->points[number];
}

}  // namespace raymoval::registration
