// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/angle.h"
#include "core/scan/local_frame.h"
#include "core/scan/reach.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval::inspection {
namespace {

/// A finding for each sentence "PLACE: problem.".
std::vector<Finding> look_damaged(Samples& samples) {
  std::vector<Finding> findings;
  for (const std::string& sentence : samples.sequence().damage) {
    const std::size_t colon = sentence.find(": ");
    const bool has_place = colon != std::string::npos;
    Finding finding;
    finding.where = has_place ? sentence.substr(0, colon) : "the recording";
    finding.what = has_place ? sentence.substr(colon + 2) : sentence;
    if (finding.what.ends_with('.')) finding.what.pop_back();
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace

std::vector<Check> recording_checks() {
  return {{"recording-damaged", "a recording is truncated or damaged, or was never closed",
           "a whole recording, because its unreadable parts are left out",
           "Copy it again and compare its size, or repair it; its readable parts are used.",
           look_damaged}};
}

namespace {

std::string metres_text(double metres) {
  return metres < 1e15 ? grouped_text(static_cast<std::uint64_t>(metres)) : number_text(metres);
}

/// Largest distance along an axis. It is NaN if a coordinate is.
double largest(const Eigen::Vector3d& offset) {
  return offset.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

/// Step between two neighbouring numbers at `magnitude`.
double double_step(double magnitude) {
  return std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
}

/// Positions in the frame of methods.
class MethodFrame {
 public:
  explicit MethodFrame(const Samples& samples)
      : T_local_world_(samples.sequence().method_frame()) {}

  /// "123,456 m from where the first scan was" for a position that is out of range; else empty.
  [[nodiscard]] std::optional<std::string> too_far(const Eigen::Vector3d& world) const {
    const double apart = largest(T_local_world_ * world);
    if (apart <= kUsualReach) return std::nullopt;
    return metres_text(apart) + " m from where the first scan was";
  }

 private:
  Pose T_local_world_;
};

std::optional<Finding> far_position(const Samples& samples, const MethodFrame& frame) {
  const std::vector<Pose>& poses = samples.poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string where = samples.pose_source() + ", frame " + samples.frame_name(i);
    if (const auto place = frame.too_far(poses[i].translation())) {
      return Finding{.where = where, .what = "the sensor is " + *place};
    }
    const double magnitude = largest(poses[i].translation());
    if (!(double_step(magnitude) <= kCoarsestPosition)) {
      return Finding{
          .where = where,
          .what = fmt::format(
              "the sensor is {} m from the world's origin, where numbers have steps of {} m",
              metres_text(magnitude), number_text(double_step(magnitude)))};
    }
  }
  return std::nullopt;
}

std::optional<Finding> far_point(const Samples& samples, const MethodFrame& frame) {
  if (samples.point_scale() != 1.0) return std::nullopt;  // Another check finds millimetres.
  for (const auto& [index, scan] : samples.scans()) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d point = scan.points[i].cast<double>();
      std::optional<std::string> place = frame.too_far(scan.T_world_sensor * point);
      const double range = point.norm();
      if (!(range <= kFarthestReturn)) place = metres_text(range) + " m from its sensor";
      if (!place) continue;
      return Finding{
          .where = samples.scan_name(index),
          .what = fmt::format("point {} lies {}", grouped_text(scan.stored_position(i)), *place)};
    }
  }
  return std::nullopt;
}

std::vector<Finding> look_out_of_reach(Samples& samples) {
  const MethodFrame frame(samples);
  std::vector<Finding> findings;
  for (const auto& look : {far_position, far_point}) {
    if (auto finding = look(samples, frame)) findings.push_back(std::move(*finding));
  }
  return findings;
}

}  // namespace

std::vector<Check> reach_checks() {
  return {{"out-of-reach", "a position or point is too far away for methods and scores",
           fmt::format("points within {} m of their sensor, and all within {} m of the first scan "
                       "along each axis, as far as the voxels of all methods reach",
                       metres_text(kFarthestReturn), metres_text(kUsualReach)),
           "Correct the row or point (are its numbers metres?), or leave the scan out with "
           "--frames; methods with small voxels would fail.",
           look_out_of_reach}};
}

namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) / kDegree;
}

std::string evidence_text(const GravityEvidence& evidence) {
  return fmt::format(
      "the ground faces {}, and of the other surfaces {} % by area are upright if up is {}",
      axis_text(evidence.ground), fixed_text(100.0 * evidence.share_upright, 0),
      axis_text(evidence.upright));
}

/// Whether up can be checked. Poses that do not fit the scans are no evidence on up.
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
           .what = fmt::format("up is {}: {}; methods get the rotated world; results and maps keep "
                               "the world of the poses",
                               axis_text(up.direction), evidence_text(evidence))}};
}

/// Compares the user's up direction with the scans.
std::vector<Finding> look_for_wrong_up(Samples& samples) {
  constexpr double kContradiction = 15.0;  // degrees
  const UpDirection up = samples.sequence().up();
  if (up.source != UpDirection::Source::kGiven || !can_tell_up(samples)) return {};
  const GravityEvidence evidence = estimate_gravity(*samples.sequence().scans, up.direction);
  const double apart = degrees_between(up.direction, evidence.up.direction);
  if (evidence.ground.isZero() || apart < kContradiction) return {};
  return {{.what = fmt::format(
               "up is given as {}, which is {} degrees from what the scans show: {}",
               axis_text(up.direction), fixed_text(apart, 0), evidence_text(evidence))}};
}

/// Step of float32 numbers at `magnitude`.
double float_step(double magnitude) {
  const auto value = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(value, 2.0F * value) - value);
}

/// Finds points on a coarse lattice: they are far from the origin and were float32 at some time.
std::vector<Finding> look_for_coarse_points(Samples& samples) {
  constexpr double kCoarse = 0.007, kExact = 0.02;
  if (!samples.points_in_world()) return {};
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
       "If another direction is up, set --up or \"up\" in sequence.json.", look_at_axes},
      {"up-contradicted", "--up or \"up\" in sequence.json is not against gravity",
       "the direction against gravity in the world of the poses",
       "Leave --up and \"up\" in sequence.json out, or correct them.", look_for_wrong_up},
      {"coordinates-coarse", "points far from the world's origin are too coarse as float32",
       "points to the millimetre",
       "Write x y z as float64 (SIZE 8 8 8), or shift points and VIEWPOINT to an origin near by.",
       look_for_coarse_points},
  };
}

}  // namespace raymoval::inspection
