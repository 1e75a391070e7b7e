// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/angle.h"
#include "core/error.h"
#include "core/scan/direction_pattern.h"
#include "core/scan/directions.h"
#include "core/scan/local_frame.h"
#include "core/scan/sensor_model.h"
#include "core/scan/spin_axis.h"
#include "core/text.h"

namespace raymoval {
namespace {

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
