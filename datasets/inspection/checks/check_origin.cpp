// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/registration/ray_origin.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kScans = 3, kFewestLines = 300;
constexpr double kNear = 0.3;  // metres: a smaller offset changes no result
/// Largest misfit of a found origin, and least gain over the misfit of the frame's origin. In
/// simulated scenes with 16 to 64 beams, the gain is at most 0.01 for right data, and 0.07 or more
/// for data in a frame 1.8 m away; two merged sensors have a misfit of 0.59. With 128 beams,
/// neighbours on a scan line are not found, and there is no finding.
constexpr double kFound = 0.56, kGain = 0.06;

/// @param given the user's origin @param right the origin in the frame of the stored points
std::string remedy_of(const Eigen::Vector3d& given, const Eigen::Vector3d& right) {
  if (right.norm() < kNear && !given.isZero()) return "Leave --sensor-origin out.";
  return fmt::format("Say --sensor-origin {},{},{}.", fixed_text(right.x(), 2),
                     fixed_text(right.y(), 2), fixed_text(right.z(), 2));
}

std::vector<Finding> look_for_ray_origin(Samples& samples) {
  if (samples.point_scale() != 1.0 || !pose_verdict(samples).check.empty()) return {};
  const std::vector<Scan> chosen = samples.some_scans(kScans);
  if (chosen.size() < kScans) return {};
  const registration::RayOrigin found = registration::find_ray_origin(chosen);
  const Eigen::Vector3d& at = found.origin;
  samples.measures.emplace_back("ray_lines", static_cast<double>(found.lines));
  samples.measures.emplace_back("ray_misfit_of_frame", found.misfit_given);
  samples.measures.emplace_back("ray_misfit_found", found.misfit_found);
  samples.measures.emplace_back("ray_origin_x", at.x());
  samples.measures.emplace_back("ray_origin_y", at.y());
  samples.measures.emplace_back("ray_origin_z", at.z());
  if (found.lines < kFewestLines || at.norm() < kNear || found.misfit_found > kFound ||
      found.misfit_given - found.misfit_found < kGain) {
    return {};
  }
  const Eigen::Vector3d given = samples.sequence().sensor_origin.value_or(Eigen::Vector3d::Zero());
  return {{.where = samples.all_frames(),
           .what = fmt::format("scan lines show that the beams start at ({}, {}, {}) m and not at "
                               "the origin of the points' frame",
                               fixed_text(at.x(), 2), fixed_text(at.y(), 2), fixed_text(at.z(), 2)),
           .remedy = remedy_of(given, given + at)}};
}

}  // namespace

std::vector<Check> origin_checks() {
  return {{"beams-start-elsewhere", "points are in the frame of a vehicle, not of the sensor",
           "points whose origin is the sensor, where the beams start",
           "Say --sensor-origin with the position of the sensor in the frame of the points.",
           look_for_ray_origin, Consequence::kRefused}};
}

}  // namespace raymoval::inspection
