// SPDX-License-Identifier: MIT
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "core/point_tree.h"
#include "core/scan/direction_pattern.h"
#include "core/scan/directions.h"
#include "core/scan/local_frame.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"

namespace raymoval {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kSamples = 1000;  ///< Directions of a scan whose neighbours are searched.
constexpr std::size_t kNeighbours = 6, kFewestSteps = 1000;
constexpr double kLeastNeighbourStep = 0.02 * kDegree;
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
      if (squares[k] < kLeastNeighbourStep * kLeastNeighbourStep) continue;
      steps.push_back({rays[i], (rays[near[k]] - rays[i]).normalized()});
      ++found;
    }
  }
}

struct Support {
  double level = 0.0;   ///< Share of the steps that are level about the axis.
  double weight = 0.0;  ///< The same, less for an axis near many directions.
};

/// @param every 1 counts all steps, 2 each second one, and so on
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

/// The axis about which the beams of a sensor turn, a unit vector of the frame of the points.
///
/// Neighbouring directions of a beam have the same elevation about this axis. So of all axes, it
/// has the largest share of neighbours that are level. The coordinate axes come first, and an axis
/// within a degree of one of them is that axis. +z always stays +z; another axis points to the side
/// to which fewer beams look, which is up for sensors on vehicles.
///
/// The result does not depend on the order of points. It is +z if there is no such axis (rosettes)
/// or if there are too few directions.
/// @param scans of one sensor
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

constexpr double kViewTail = 1e-4;  ///< Share of the points beyond either end of the field of view.

/// The angle below which the share `quantile` of them lies. @param angles reordered
double quantile_of(std::vector<double>& angles, double quantile) {
  const auto at = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(angles.size() - 1));
  std::nth_element(angles.begin(), angles.begin() + at, angles.end());
  return angles[static_cast<std::size_t>(at)];
}

/// The middle of the widest arc in which there is next to nothing, radians; pi if none is wide
/// enough to be a limit of the sensor.
double azimuth_gap(const std::vector<double>& azimuths) {
  constexpr int kArcs = 720, kLeastArcs = 20;  // A wide gap has at least 10 degrees.
  constexpr double kNothing = 0.01;            // Of the mean number of points in an arc.
  std::array<double, kArcs> counts = {};
  for (const double azimuth : azimuths) {
    const int arc = static_cast<int>((azimuth + std::numbers::pi) / kTurn * kArcs);
    ++counts[static_cast<std::size_t>(std::clamp(arc, 0, kArcs - 1))];
  }
  const double nothing = kNothing * static_cast<double>(azimuths.size()) / kArcs;
  int widest = 0, end = 0, run = 0;
  for (int arc = 0; arc < 2 * kArcs; ++arc) {
    run = counts[static_cast<std::size_t>(arc % kArcs)] <= nothing ? std::min(run + 1, kArcs) : 0;
    if (run > widest) {
      widest = run;
      end = arc + 1;
    }
  }
  if (widest < kLeastArcs) return std::numbers::pi;
  return (end - 0.5 * widest) / kArcs * kTurn - std::numbers::pi;
}

/// All directions of some scans, and their common bounds.
struct Seen {
  std::vector<Directions> scans;
  std::vector<double> azimuths, elevations;
  double nearest = 1e300, farthest = 0.0;

  explicit Seen(const std::vector<Scan>& all) {
    for (const Scan& scan : all) {
      scans.emplace_back(scan);
      for (std::size_t i = 0; i < scans.back().size(); ++i) {
        azimuths.push_back(scans.back()[i].azimuth);
        elevations.push_back(scans.back()[i].elevation);
      }
      for (const Eigen::Vector3f& point : scan.points) {
        const double range = point.cast<double>().norm();
        if (!(range > 1e-3)) continue;
        nearest = std::min(nearest, range);
        farthest = std::max(farthest, range);
      }
    }
  }
};

void set_azimuths(std::vector<double>& azimuths, SensorModel& model) {
  const double cut = azimuth_gap(azimuths);
  for (double& azimuth : azimuths) {
    azimuth -= cut;
    azimuth -= kTurn * std::floor(azimuth / kTurn);
  }
  const double low = quantile_of(azimuths, kViewTail);
  const double high = quantile_of(azimuths, 1.0 - kViewTail);
  if (high - low > 350.0 * kDegree) return;
  model.azimuth_min = cut + low;
  if (model.azimuth_min >= std::numbers::pi) model.azimuth_min -= kTurn;
  model.azimuth_max = model.azimuth_min + high - low;
}

bool near(double a, double b) {
  constexpr double kPart = 0.08;
  return std::abs(a - b) <= kPart * b;
}

/// The known sensor with the steps and field of view of `pattern`, if there is one. Without objects
/// above or below, the observed field of view is smaller than the sensor's.
std::optional<SensorModel> recognised(const DirectionPattern& pattern, double low, double high) {
  constexpr double kMargin = 2.0 * kDegree;
  if (pattern.kind != DirectionPattern::Kind::kColumns) return {};
  for (const std::string& name : sensor_model_names()) {
    const SensorModel known = sensor_model_named(name);
    if (!near(pattern.azimuth_step, known.azimuth_step)) continue;
    if (!near(pattern.elevation_step, known.elevation_step)) continue;
    const double below = known.elevation_min - low, above = high - known.elevation_max;
    if (std::max(below, above) > kMargin || std::max(-below, -above) > 15.0 * kMargin) continue;
    if (std::min(std::abs(below), std::abs(above)) <= kMargin) return known;
  }
  return {};
}

std::string degrees_text(double radians, int decimals) {
  return fixed_text(radians / kDegree, decimals) + " deg";
}

std::string basis_text(const SensorModel& model, const DirectionPattern& pattern, std::size_t scans,
                       std::size_t directions) {
  using Kind = DirectionPattern::Kind;
  const std::string by =
      degrees_text(pattern.azimuth_step, 3) + " by " + degrees_text(pattern.elevation_step, 3);
  std::string text;
  switch (pattern.kind) {
    case Kind::kUnknown:
      text = "too few directions for steps";
      break;
    case Kind::kColumns:
      text = counted_text(static_cast<std::size_t>(pattern.beams), "beam") + ", " + by;
      break;
    case Kind::kBeams:
      text = counted_text(static_cast<std::size_t>(pattern.beams), "beam") +
             " without even columns, on average " + by;
      break;
    case Kind::kScattered:
      text = "neither beams nor columns, " + degrees_text(pattern.azimuth_step, 3) + " apart";
      break;
  }
  return text + ", view of " + degrees_text(model.azimuth_max - model.azimuth_min, 0) + " by " +
         degrees_text(model.elevation_max - model.elevation_min, 0) + ", from " +
         counted_text(scans, "scan") + " with " + grouped_text(directions) + " directions";
}

/// @param seen reordered
SensorModel model_about_z(Seen& seen) {
  SensorModel model;
  model.name = "estimated";
  const std::size_t directions = seen.azimuths.size();
  const double low = quantile_of(seen.elevations, kViewTail);
  const double high = quantile_of(seen.elevations, 1.0 - kViewTail);
  // A few points near the sensor lie beyond its beams, which do not start in one place.
  constexpr double kBeamTail = 1e-3;
  const double lowest_beam = quantile_of(seen.elevations, kBeamTail);
  const double highest_beam = quantile_of(seen.elevations, 1.0 - kBeamTail);
  const DirectionPattern pattern = find_direction_pattern(seen.scans, lowest_beam, highest_beam);
  model.azimuth_step = pattern.azimuth_step;
  model.elevation_step = pattern.elevation_step;
  model.beams = pattern.beams;
  model.elevation_min = low;
  model.elevation_max = high;
  set_azimuths(seen.azimuths, model);
  model.range_min = seen.nearest;
  model.range_max = seen.farthest;
  model.basis = basis_text(model, pattern, seen.scans.size(), directions);
  // A data sheet is more exact, and naming the sensor then changes no bin.
  constexpr double kFewNear = 5e-3;  // A beam of 64 has three times as many points.
  if (const auto known = recognised(pattern, quantile_of(seen.elevations, kFewNear),
                                    quantile_of(seen.elevations, 1.0 - kFewNear))) {
    model.azimuth_step = known->azimuth_step;
    model.elevation_step = known->elevation_step;
    model.elevation_min = known->elevation_min;
    model.elevation_max = known->elevation_max;
    model.basis += "; the data sheet of '" + known->name + "' fits and is used";
  }
  return model;
}

/// The model about `axis`; nothing if no beams turn about it.
std::optional<SensorModel> model_about(const Eigen::Vector3d& axis, std::vector<Scan> scans) {
  for (Scan& scan : scans) turn_sensor_frame(turn_to_z(axis), scan);
  Seen seen(scans);
  SensorModel model = model_about_z(seen);
  if (!model.has_beams()) return std::nullopt;
  model.spin_axis = axis;
  model.basis += "; spin axis: " + axis_text(axis);
  return model;
}

}  // namespace

SensorModel estimate_sensor_model(const std::vector<Scan>& scans) {
  Seen seen(scans);
  if (seen.azimuths.empty()) {
    throw DataError("the sensor cannot be estimated: none of " + std::to_string(scans.size()) +
                    " sampled scans has a point. Name it with \"sensor\" in sequence.json.");
  }
  const Eigen::Vector3d axis = find_spin_axis(seen.scans);
  if (axis != Eigen::Vector3d::UnitZ()) {
    if (auto model = model_about(axis, scans)) return *std::move(model);
  }
  return model_about_z(seen);
}

Eigen::Vector3d estimate_spin_axis(const std::vector<Scan>& scans) {
  const Eigen::Vector3d axis = find_spin_axis({scans.begin(), scans.end()});
  const bool is_z = axis == Eigen::Vector3d::UnitZ();
  return is_z || model_about(axis, scans) ? axis : Eigen::Vector3d::UnitZ();
}

}  // namespace raymoval
