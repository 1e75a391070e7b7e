// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/scan/reach.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"

namespace raymoval::inspection {
namespace {

std::string metres_text(double metres) {
  return metres < 1e15 ? grouped_text(static_cast<std::uint64_t>(metres)) : number_text(metres);
}

/// Largest distance along an axis. It is not a number if one of them is not.
double largest(const Eigen::Vector3d& offset) {
  return offset.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

/// Step between two neighbouring numbers at `magnitude`.
double double_step(double magnitude) {
  return std::nextafter(magnitude, std::numeric_limits<double>::infinity()) - magnitude;
}

/// Places in the frame that methods run in.
class MethodFrame {
 public:
  explicit MethodFrame(const Samples& samples)
      : T_local_world_(samples.sequence().method_frame()) {}

  /// "123,456 m from where the first scan was" for a place that is out of reach; else nothing.
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
      return Finding{.where = where, .what = "the sensor stands " + *place};
    }
    const double magnitude = largest(poses[i].translation());
    if (!(double_step(magnitude) <= kCoarsestPosition)) {
      return Finding{
          .where = where,
          .what = fmt::format("the sensor stands {} m from the world's origin, where "
                              "numbers have steps of {} m",
                              metres_text(magnitude), number_text(double_step(magnitude)))};
    }
  }
  return std::nullopt;
}

std::optional<Finding> far_point(const Samples& samples, const MethodFrame& frame) {
  if (samples.point_scale() != 1.0) return std::nullopt;  // Millimetres are found elsewhere.
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
  return {{"out-of-reach", "a position or point is farther away than methods and scores reach",
           fmt::format("points within {} m of their sensor, and all within {} m of the first scan "
                       "along each axis, as far as the voxels of all methods reach",
                       metres_text(kFarthestReturn), metres_text(kUsualReach)),
           "Correct the row or point (are its numbers metres?), or leave the scan out with "
           "--frames; methods with small voxels would fail.",
           look_out_of_reach}};
}

}  // namespace raymoval::inspection
