// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/world_axes/gravity.h"

namespace raymoval::inspection {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) / kDegree;
}

std::string evidence_text(const GravityEvidence& evidence) {
  return fmt::format(
      "the ground faces {}, and of the other surfaces {} % by area stand upright if up is {}",
      up_text(evidence.ground), fixed_text(100.0 * evidence.share_upright, 0),
      up_text(evidence.upright));
}

/// Poses that do not fit the scans say nothing about up.
bool can_tell_up(Samples& samples) {
  return samples.point_scale() == 1.0 && pose_verdict(samples).check.empty();
}

std::vector<Finding> look_at_axes(Samples& samples) {
  if (!can_tell_up(samples)) return {};
  const UpDirection up = samples.sequence().up();
  samples.measures.emplace_back("up_from_world_z_degrees",
                                degrees_between(up.direction, Eigen::Vector3d::UnitZ()));
  if (up.source != UpDirection::Source::kEstimated) return {};
  const GravityEvidence evidence = estimate_gravity(*samples.sequence().scans);
  return {{.severity = Severity::kNote,
           .what = fmt::format("up is {}: {}; methods get the world turned, results and maps stay "
                               "as the poses have them",
                               up_text(up.direction), evidence_text(evidence))}};
}

/// What a user said against what the scans show.
std::vector<Finding> look_for_wrong_up(Samples& samples) {
  constexpr double kContradiction = 15.0;  // degrees
  const UpDirection up = samples.sequence().up();
  if (up.source != UpDirection::Source::kGiven || !can_tell_up(samples)) return {};
  const GravityEvidence evidence = estimate_gravity(*samples.sequence().scans);
  const double apart = degrees_between(up.direction, evidence.up.direction);
  if (evidence.ground.isZero() || apart < kContradiction) return {};
  return {
      {.what = fmt::format("up is given as {}, which is {} degrees from what the scans show: {}",
                           up_text(up.direction), fixed_text(apart, 0), evidence_text(evidence))}};
}

/// Step of float32 numbers at `magnitude`.
double float_step(double magnitude) {
  const auto value = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(value, 2.0F * value) - value);
}

/// Points of a far world that were float32 once lie on a coarse lattice, however they are stored.
std::vector<Finding> look_for_coarse_points(Samples& samples) {
  constexpr double kCoarse = 0.007, kExact = 0.02;
  if (!samples.layout().points_in_world) return {};
  for (const auto& [index, scan] : samples.scans()) {
    const Eigen::Vector3d position = scan.T_world_sensor.translation();
    Eigen::Index axis = 0;
    const double magnitude = position.cwiseAbs().maxCoeff(&axis);
    const double step = magnitude > kFarFromOrigin ? float_step(magnitude) : 0.0;
    if (step < kCoarse || scan.size() < 100) continue;
    std::size_t on_lattice = 0;
    for (const Eigen::Vector3f& point : scan.points) {
      const double place = (scan.T_world_sensor * point.cast<double>())[axis] / step;
      on_lattice += std::abs(place - std::round(place)) < kExact ? 1 : 0;
    }
    if (10 * on_lattice < 9 * scan.size()) continue;
    return {{.where = samples.scan_name(index),
             .what = fmt::format("points {} m from the world's origin lie in steps of {} m, as "
                                 "float32 numbers do there",
                                 grouped_text(static_cast<std::uint64_t>(magnitude)),
                                 fixed_text(step, 3))}};
  }
  return {};
}

}  // namespace

std::vector<Check> world_checks() {
  return {
      {"world-axes", "the z axis of the poses' world is not up", "up along any axis",
       "If something else is up, say so with --up or \"up\" in sequence.json.", look_at_axes},
      {"up-contradicted", "--up or \"up\" in sequence.json is not against gravity",
       "the direction against gravity in the world of the poses",
       "Leave --up and \"up\" in sequence.json out, or correct them.", look_for_wrong_up},
      {"coordinates-coarse", "points far from the world's origin lost their digits as float32",
       "points to the millimetre",
       "Write x y z as float64 (SIZE 8 8 8), or shift points and VIEWPOINT to an origin near by.",
       look_for_coarse_points},
  };
}

}  // namespace raymoval::inspection
