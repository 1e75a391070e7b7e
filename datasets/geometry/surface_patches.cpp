// SPDX-License-Identifier: MIT
#include "datasets/geometry/surface_patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/morton.h"

namespace raymoval {
namespace {

using MillimetrePoint = Eigen::Vector3i;

constexpr float kNearest = 1.0F, kFarthest = 30.0F;  // metres
constexpr int kSmallestBits = 9, kLargestBits = 12;  // Cells of 512 mm to 4,096 mm.
constexpr std::size_t kFewest = 8;                   // points of a patch
constexpr double kThickness = 0.05;                  // metres, standard deviation across a surface
constexpr double kFlatness = 5.0;  // Least ratio of the short side of a patch to its thickness.

/// Points in the order of a space-filling curve: those of a cell of any size stand together.
struct PlacedPoint {
  std::uint64_t code = 0;
  MillimetrePoint at;
};

std::vector<PlacedPoint> placed_points(const Scan& scan) {
  constexpr int kBias = 1 << 17;  // 131 m: no coordinate is negative.
  std::vector<PlacedPoint> placed;
  placed.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) {
    const float range = point.norm();
    if (!(range >= kNearest && range <= kFarthest)) continue;
    PlacedPoint p;
    std::uint64_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      p.at[axis] = static_cast<int>(std::lround(static_cast<double>(point[axis]) * 1000.0));
      cell[axis] = static_cast<std::uint64_t>(p.at[axis] + kBias) >> kSmallestBits;
    }
    p.code = spread_bits(cell[0]) | spread_bits(cell[1]) << 1 | spread_bits(cell[2]) << 2;
    placed.push_back(p);
  }
  std::sort(placed.begin(), placed.end(),
            [](const PlacedPoint& a, const PlacedPoint& b) { return a.code < b.code; });
  return placed;
}

/// Sums over the points of a cell, in whole millimetres from a corner so that they are exact.
struct Sums {
  std::int64_t count = 0;
  Eigen::Matrix<std::int64_t, 3, 1> first = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
  Eigen::Matrix<std::int64_t, 3, 3> second = Eigen::Matrix<std::int64_t, 3, 3>::Zero();
};

/// @return whether the points of `sums` lie on a plane
bool make_patch(const Sums& sums, const MillimetrePoint& corner, SurfacePatch& patch) {
  constexpr double kMetre = 0.001;
  const auto count = static_cast<double>(sums.count);
  const Eigen::Vector3d mean = sums.first.cast<double>() / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect((sums.second.cast<double>() / count - mean * mean.transpose()) *
                       (kMetre * kMetre));
  const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (spread[0] > kThickness || spread[1] < kFlatness * std::max(spread[0], 0.01)) return false;
  patch.mean = (corner.cast<double>() + mean) * kMetre;
  patch.normal = solver.eigenvectors().col(0);
  if (patch.normal.dot(patch.mean) > 0.0) patch.normal = -patch.normal;
  patch.area = 12.0 * spread[1] * spread[2];  // Of a rectangle with these deviations.
  return true;
}

/// Patches of the points [begin, end), which share a cell of 2^bits millimetres.
void add_patches(const std::vector<PlacedPoint>& points, std::size_t begin, std::size_t end,
                 int bits, std::vector<SurfacePatch>& patches) {
  if (end - begin < kFewest) return;
  const MillimetrePoint corner =
      points[begin].at.unaryExpr([bits](int value) { return (value >> bits) * (1 << bits); });
  Sums sums;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Matrix<std::int64_t, 3, 1> p = (points[i].at - corner).cast<std::int64_t>();
    ++sums.count;
    sums.first += p;
    sums.second += p * p.transpose();
  }
  SurfacePatch patch;
  if (make_patch(sums, corner, patch)) {
    patches.push_back(patch);
    return;
  }
  if (bits == kSmallestBits) return;
  const int shift = 3 * (bits - 1 - kSmallestBits);
  for (std::size_t first = begin, i = begin + 1; i <= end; ++i) {
    if (i < end && points[i].code >> shift == points[first].code >> shift) continue;
    add_patches(points, first, i, bits - 1, patches);
    first = i;
  }
}

}  // namespace

std::vector<SurfacePatch> surface_patches(const Scan& scan) {
  const std::vector<PlacedPoint> points = placed_points(scan);
  std::vector<SurfacePatch> patches;
  constexpr int kShift = 3 * (kLargestBits - kSmallestBits);
  for (std::size_t first = 0, i = 1; i <= points.size(); ++i) {
    if (i < points.size() && points[i].code >> kShift == points[first].code >> kShift) continue;
    add_patches(points, first, i, kLargestBits, patches);
    first = i;
  }
  return patches;
}

}  // namespace raymoval
