// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"

namespace raymoval::inspection {
namespace {

Check verdict_check(const std::string& name, const std::string& finds, const std::string& expected,
                    const std::string& remedy) {
  const auto look = [name](Samples& samples) {
    const PoseVerdict& verdict = pose_verdict(samples);
    if (verdict.check != name) return std::vector<Finding>();
    return std::vector<Finding>{{.what = verdict.what, .remedy = verdict.remedy}};
  };
  return {name, finds, expected, remedy, look, Consequence::kRefused};
}

/// Points right below `centre`, where a sensor's own blind zone is.
std::size_t points_below(const Scan& scan, const Eigen::Vector3d& centre) {
  std::size_t count = 0;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d offset = scan.T_world_sensor * point.cast<double>() - centre;
    if (offset.head<2>().norm() < 1.0 && offset.z() < -0.5) ++count;
  }
  return count;
}

/// Points in the world frame agree whatever VIEWPOINT says; but a sensor sees no ground right below
/// itself.
std::vector<Finding> look_for_sensor(Samples& samples) {
  constexpr std::size_t kMany = 8, kFew = 2;
  if (!samples.layout().points_in_world || !pose_verdict(samples).check.empty()) return {};
  std::size_t given = 0, inverse = 0;
  for (const auto& [index, scan] : samples.scans()) {
    if (points_below(scan, scan.T_world_sensor.translation()) >= kMany) ++given;
    const std::size_t below = points_below(scan, scan.T_world_sensor.inverse().translation());
    if (below <= kFew) ++inverse;
  }
  const std::size_t count = samples.scans().size();
  if (2 * given <= count) return {};
  Finding finding;
  finding.check = 10 * inverse >= 9 * count ? "poses-inverted" : "viewpoint-missing";
  finding.what = grouped_text(given) + " of " + grouped_text(count) +
                 " scans have points right below the position that VIEWPOINT gives, where no " +
                 "sensor sees the ground";
  if (finding.check == "poses-inverted") {
    finding.what += "; below the position of the inverse pose there are none";
    finding.remedy =
        "Write the pose of the sensor in the world (T_world_sensor) into VIEWPOINT, "
        "not its inverse.";
  } else {
    finding.remedy =
        "Write the position and attitude of the sensor at each scan into its "
        "VIEWPOINT; points in the world frame do not tell where they were seen from.";
  }
  return {finding};
}

}  // namespace

std::vector<Check> pose_checks() {
  const std::string agree = "scans that lie on each other under T_world_sensor of each";
  return {
      verdict_check("poses-inverted", "poses take the world to the sensor (T_sensor_world)", agree,
                    "Invert each pose: R^T and -R^T t. For a pose file, --pose-format inverse does "
                    "that."),
      verdict_check(
          "camera-frame", "poses or points are in camera axes, not in the LiDAR's",
          "LiDAR axes: x ahead, y left, z up, in points and poses alike",
          "Poses of a camera: take them to the LiDAR with T = Tr^-1 P Tr (in "
          "SemanticKITTI layout put 'Tr:' into calib.txt and leave \"poses_are_lidar\" "
          "out; elsewhere say --T-sensor with the pose of the LiDAR in the camera's frame). "
          "Points of a camera frame: bring them to the LiDAR with Tr^-1."),
      verdict_check("lidar-poses-as-camera",
                    "poses of the LiDAR are read as those of a camera (or the points, not the "
                    "poses, are in camera axes)",
                    "camera poses beside a calib.txt with 'Tr:'",
                    "Say \"poses_are_lidar\": true in sequence.json."),
      verdict_check("degrees-for-radians", "rotations are made from degrees as if from radians",
                    agree, "Multiply the angles by pi/180 before the rotations are made."),
      verdict_check("radians-for-degrees", "rotations are made from radians as if from degrees",
                    agree, "Multiply the angles by 180/pi before the rotations are made."),
      verdict_check(
          "quaternion-order", "the quaternion's numbers stand in another order",
          "TUM rows: t x y z qx qy qz qw; VIEWPOINT: tx ty tz qw qx qy qz",
          "For a pose file say --pose-format euroc if w is the first of the four numbers, or "
          "--pose-format tum if it is the last. Else reorder the columns."),
      verdict_check("poses-in-millimetres", "positions of the poses are millimetres", "metres",
                    "Divide the positions by 1,000."),
      verdict_check("poses-in-kilometres", "positions of the poses are kilometres", "metres",
                    "Multiply the positions by 1,000."),
      verdict_check("points-in-feet", "points are feet while the poses are metres", "metres",
                    "Multiply the coordinates by 0.3048. If they are metres all the same, multiply "
                    "the positions of the poses by 3.2808."),
      verdict_check("poses-coarse", "positions far from the origin lost their digits",
                    "positions to the millimetre",
                    "Write positions with all their digits (in C++ std::setprecision(12)), or "
                    "shift them to an origin near by."),
      verdict_check("viewpoint-twice", "VIEWPOINT is applied to the stored points twice",
                    "stored points = T p with T from VIEWPOINT and p in the sensor frame",
                    "Apply VIEWPOINT once when writing the points."),
      verdict_check("viewpoint-missing",
                    "VIEWPOINT is not applied to the stored points, or is not "
                    "the pose of the sensor",
                    "stored points = T p with T from VIEWPOINT and p in the sensor frame",
                    "Write points in the world frame: T p with T from VIEWPOINT. Or put the scans "
                    "beside a pose file, where points stay in the sensor frame."),
      {"sensor-elsewhere", "the sensor does not stand where VIEWPOINT says",
       "VIEWPOINT = tx ty tz qw qx qy qz, the pose of the sensor",
       "Write the pose of the sensor at each scan into its VIEWPOINT.", look_for_sensor,
       Consequence::kRefused},
      verdict_check("points-in-world", "points stand in the world frame though there are poses",
                    "points in the frame of the sensor", "Say --points world."),
      verdict_check(
          "poses-shifted", "poses are those of the scan before or after", agree,
          "Shift the rows of the pose file by one, so that row N belongs to scan N. If poses "
          "and scans have times, say --time-offset with the time of a scan, or its negative."),
      verdict_check("poses-of-a-body", "poses are those of a body on which the sensor is turned",
                    agree,
                    "Say where the sensor is on the body (--T-sensor), or mend 'Tr' of calib.txt."),
      verdict_check("poses-of-another-time", "scans and poses are of clocks that differ by much",
                    agree, "Say --time-offset with the time of poses less that of scans."),
      verdict_check(
          "poses-of-another-sequence", "poses do not belong to these scans", agree,
          "Take the pose file that belongs to these scans (--poses FILE). If its poses are "
          "those of a body that carries the sensor, say where the sensor is on it "
          "(--T-sensor). If its clock is another one, say --time-offset."),
  };
}

}  // namespace raymoval::inspection
