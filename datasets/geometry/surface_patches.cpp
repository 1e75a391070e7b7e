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

using PlacedPoints = std::span<const PlacedPoint>;

constexpr int kSmallestBits = 9, kLargestBits = 12;  // Cells of 512 mm to 4,096 mm.
constexpr std::size_t kFewest = 8;                   // points of a patch
constexpr double kThickness = 0.05;                  // metres, standard deviation across a surface
constexpr double kFlatness = 5.0;  // Least ratio of the short side of a patch to its thickness.

std::vector<PlacedPoint> placed_points(const Scan& scan, float nearest, float farthest) {
  constexpr int kBias = 1 << 17;  // 131 m: no coordinate is negative.
  std::vector<PlacedPoint> placed;
  placed.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) {
    const float range = point.norm();
    if (!(range >= nearest && range <= farthest)) continue;
    PlacedPoint p;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = static_cast<double>(point[axis]) * 1000.0;
      p.at[axis] = static_cast<int>(at + std::copysign(0.5, at));  // Faster than std::lround.
      const auto cell = static_cast<std::uint64_t>(p.at[axis] + kBias) >> kPlacedBits;  // 10 bits
      p.code |= static_cast<std::uint32_t>(spread_bits(cell) << axis);
    }
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
bool make_patch(const Sums& sums, const Eigen::Vector3i& corner, SurfacePatch& patch) {
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

/// Visits the patches of `points`, which share a cell of 2^bits millimetres.
void visit_patches(PlacedPoints points, int bits, const PatchVisit& visit) {
  if (points.size() < kFewest) return;
  const Eigen::Vector3i corner =
      points[0].at.unaryExpr([bits](int value) { return (value >> bits) * (1 << bits); });
  Sums sums;
  for (const PlacedPoint& point : points) {
    const Eigen::Matrix<std::int64_t, 3, 1> p = (point.at - corner).cast<std::int64_t>();
    ++sums.count;
    sums.first += p;
    sums.second += p * p.transpose();
  }
  SurfacePatch patch;
  if (make_patch(sums, corner, patch)) {
    visit(patch, points);
  } else if (bits > kSmallestBits) {
    for_each_cell(points, bits - 1,
                  [&](PlacedPoints cell) { visit_patches(cell, bits - 1, visit); });
  }
}

}  // namespace

void for_each_patch(const Scan& scan, float nearest, float farthest, const PatchVisit& visit) {
  for_each_cell(placed_points(scan, nearest, farthest), kLargestBits,
                [&](PlacedPoints cell) { visit_patches(cell, kLargestBits, visit); });
}

}  // namespace raymoval
