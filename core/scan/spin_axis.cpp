// SPDX-License-Identifier: MIT
#include "core/scan/spin_axis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/point_tree.h"

namespace raymoval {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kSamples = 1000;  ///< Directions of a scan whose neighbours are searched.
constexpr std::size_t kNeighbours = 6, kFewestSteps = 1000;
constexpr double kLeastStep = 0.02 * kDegree;
/// Share of level neighbours. Random neighbours have 0.13, a rosette up to 0.15, a spinning sensor
/// 0.3 to 0.99.
constexpr double kLeastLevel = 0.22;
constexpr double kSnap = 1.0 * kDegree;

/// A step from a direction to a neighbour, as unit vectors.
struct Step {
  Vector3d from, along;

  /// The square of the sine of the elevation of `from` about `axis`.
  [[nodiscard]] double square_height(const Vector3d& axis) const {
    return from.dot(axis) * from.dot(axis);
  }
  /// The square of the slope: 0 along a beam that turns about `axis`, 1 towards `axis`.
  [[nodiscard]] double square_slope(const Vector3d& axis) const {
    constexpr double kAtPole = 0.03;  // There, every step is steep.
    const double flat = 1.0 - square_height(axis);
    return flat < kAtPole ? 1.0 : along.dot(axis) * along.dot(axis) / flat;
  }
};

void add_steps(const Directions& scan, std::vector<Step>& steps) {
  constexpr std::size_t kSearched = 2 * kNeighbours;  // With the direction, and others too near.
  if (scan.size() < kSearched) return;
  std::vector<Vector3d> rays;
  rays.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double flat = std::cos(scan[i].elevation);
    rays.emplace_back(flat * std::cos(scan[i].azimuth), flat * std::sin(scan[i].azimuth),
                      std::sin(scan[i].elevation));
  }
  const PointTree<Vector3d, double> tree(rays);
  std::vector<std::uint32_t> near(kSearched);
  std::vector<double> squares(kSearched);
  for (const std::size_t i : scan.sample(kSamples)) {
    tree.find_nearest(rays[i].data(), near, squares);
    std::size_t found = 0;
    for (std::size_t k = 0; k < kSearched && found < kNeighbours; ++k) {
      if (squares[k] < kLeastStep * kLeastStep) continue;
      steps.push_back({rays[i], (rays[near[k]] - rays[i]).normalized()});
      ++found;
    }
  }
}

struct Support {
  double level = 0.0;   ///< Share of the steps that are level about the axis.
  double weight = 0.0;  ///< The same, less for an axis near many directions.
};

/// @param every only each so many-th step is counted
Support support_of(const Vector3d& axis, const std::vector<Step>& steps, std::size_t every = 1) {
  constexpr double kLevel = 0.2;  // Slope.
  // The columns of a dense sensor are level about horizontal axes, but these are near directions.
  constexpr double kPenalty = 3.0, kLeastWeight = 0.2;
  double level = 0.0, height = 0.0, count = 0.0;
  for (std::size_t i = 0; i < steps.size(); i += every) {
    level += steps[i].square_slope(axis) < kLevel * kLevel ? 1.0 : 0.0;
    height += steps[i].square_height(axis);
    count += 1.0;
  }
  const double share = level / count;
  return {share, share * std::max(kLeastWeight, 1.0 - kPenalty * height / count)};
}

/// z, y, x, and axes spread evenly over the half sphere, about five degrees apart.
std::vector<Vector3d> candidates() {
  constexpr int kAxes = 900;
  std::vector<Vector3d> axes = {Vector3d::UnitZ(), Vector3d::UnitY(), Vector3d::UnitX()};
  for (int i = 0; i < kAxes; ++i) {
    const double z = (i + 0.5) / kAxes, flat = std::sqrt(1.0 - z * z);
    const double azimuth = i * kTurn / std::numbers::phi;
    axes.emplace_back(flat * std::cos(azimuth), flat * std::sin(azimuth), z);
  }
  return axes;
}

/// The first candidate with nearly the greatest weight.
Vector3d best_candidate(const std::vector<Step>& steps) {
  constexpr double kNearly = 0.9;
  constexpr std::size_t kEvery = 5;
  const std::vector<Vector3d> axes = candidates();
  std::vector<double> weights;
  for (const Vector3d& axis : axes) weights.push_back(support_of(axis, steps, kEvery).weight);
  const double least = kNearly * *std::max_element(weights.begin(), weights.end());
  if (const auto first = std::find_if(weights.begin(), weights.begin() + 3,
                                      [&](double weight) { return weight >= least; });
      first != weights.begin() + 3) {
    return axes[static_cast<std::size_t>(first - weights.begin())];
  }
  return axes[static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) -
                                       weights.begin())];
}

/// The axis to which the level steps are perpendicular: the eigenvector of the smallest eigenvalue
/// of their moments, with weights that fall with the slope about the last axis.
Vector3d refined(Vector3d axis, const std::vector<Step>& steps) {
  constexpr double kHighest = 0.91;  // Of `square_height`; nearer to the axis, steps are short.
  constexpr int kRounds = 10;
  for (const double slope : {0.3, 0.1, 0.05}) {
    for (int round = 0; round < kRounds; ++round) {
      Matrix3d moments = Matrix3d::Zero();
      for (const Step& step : steps) {
        const double height = step.square_height(axis);
        if (height > kHighest) continue;
        const double weight = std::exp(-step.square_slope(axis) / (2.0 * slope * slope));
        moments += weight / (1.0 - height) * step.along * step.along.transpose();
      }
      const Vector3d next = Eigen::SelfAdjointEigenSolver<Matrix3d>(moments).eigenvectors().col(0);
      axis = next.dot(axis) < 0.0 ? Vector3d(-next) : next;
    }
  }
  return axis;
}

/// The coordinate axis within `kSnap` of `axis`, or `axis`.
Vector3d snapped(const Vector3d& axis) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) >= std::cos(kSnap)) return Vector3d::Unit(i);
  }
  return axis;
}

}  // namespace

Vector3d find_spin_axis(const std::vector<Directions>& scans) {
  std::vector<Step> steps;
  for (const Directions& scan : scans) add_steps(scan, steps);
  if (steps.size() < kFewestSteps) return Vector3d::UnitZ();
  const Vector3d axis = snapped(refined(best_candidate(steps), steps));
  if (axis == Vector3d::UnitZ() || support_of(axis, steps).level < kLeastLevel) {
    return Vector3d::UnitZ();
  }
  double height = 0.0;
  for (const Step& step : steps) height += step.from.dot(axis);
  return height > 0.0 ? Vector3d(-axis) : axis;
}

}  // namespace raymoval
