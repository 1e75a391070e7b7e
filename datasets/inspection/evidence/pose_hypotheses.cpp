// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/pose_hypotheses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_file.h"

namespace raymoval::inspection {
namespace {

using Eigen::Matrix3d;

/// Distance between scans beyond which another unit is tried, metres: no vehicle moves so far, even
/// at one scan per second. A gap between two drives is not enough.
constexpr double kTooFast = 50.0;

bool are_too_fast(const std::vector<Pose>& poses) {
  std::size_t fast = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if ((poses[i].translation() - poses[i - 1].translation()).norm() > kTooFast) ++fast;
  }
  return 10 * fast >= poses.size();
}

Pose with_rotation(const Pose& pose, const Matrix3d& rotation) {
  Pose result = pose;
  result.linear() = rotation;
  return result;
}

/// The rotation if the quaternion's columns are read in the other order.
Matrix3d reordered_quaternion(const Matrix3d& rotation, bool written_w_first) {
  const Eigen::Quaterniond q(rotation);
  return (written_w_first ? Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())
                          : Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()))
      .normalized()
      .toRotationMatrix();
}

/// Maps points of a LiDAR (x ahead, y left, z up) to a camera (x right, y down, z ahead).
Pose camera_axes() {
  Pose C = Pose::Identity();
  C.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return C;
}

/// The camera of the calibration if there is one, else the axes alone.
Pose camera_of(const Samples& samples) {
  const std::string& file = samples.layout().calibration_file;
  if (file.empty() || samples.files().empty()) return camera_axes();
  const auto calibration = samples.files().front().path.parent_path().parent_path() / file;
  if (!has_file(calibration)) return camera_axes();
  try {
    const Pose Tr = read_calibration(calibration, "Tr");
    return Eigen::AngleAxisd(Tr.linear()).angle() > 0.5 ? Tr : camera_axes();
  } catch (const UnreadableError&) {
    throw;
  } catch (const Error&) {
    return camera_axes();  // With poses_are_lidar, the row is not used.
  }
}

bool read_quaternions(const Samples& samples) {
  if (samples.files().empty() || samples.has_viewpoints()) return true;
  const auto folder = samples.files().front().path.parent_path();
  for (const auto& place : {folder, folder.parent_path()}) {
    const auto path = place / samples.sequence().poses_file;
    if (is_file(path)) return read_pose_file(path).has_quaternions;
  }
  return true;
}

/// Whether the poses are written with quaternions; true if unknown.
bool have_quaternions(Samples& samples) {
  if (!samples.quaternions) samples.quaternions = read_quaternions(samples);
  return *samples.quaternions;
}

/// Points in camera axes with poses of the LiDAR move like LiDAR points with poses of a camera, and
/// vice versa, so each motion is added once.
void add_frame_hypotheses(const std::vector<Pose>& poses, const Pose& C,
                          std::vector<PoseHypothesis>& all) {
  all.push_back({"camera-frame", "if the poses are those of a camera (x right, y down, z ahead)",
                 [&poses, C](std::size_t i) { return C.inverse() * poses[i] * C; }});
  all.push_back({"lidar-poses-as-camera",
                 "if the poses are already those of the LiDAR, so that 'Tr' must not be applied",
                 [&poses, C](std::size_t i) { return C * poses[i] * C.inverse(); }});
}

void add_world_hypotheses(const Samples& samples, std::vector<PoseHypothesis>& all) {
  const auto& poses = samples.poses();
  if (samples.points_in_world()) {
    all.push_back({"viewpoint-twice", "if VIEWPOINT is taken off the stored points once more",
                   [](std::size_t) { return Pose(Pose::Identity()); }});
    all.push_back({"viewpoint-missing", "once VIEWPOINT is applied to the stored points",
                   [&poses](std::size_t i) { return poses[i] * poses[i]; }});
  } else {
    all.push_back({"points-in-world", "if the points are used as stored, without the poses",
                   [](std::size_t) { return Pose(Pose::Identity()); }});
  }
}

}  // namespace

std::vector<MisreadPoses> misread_poses(Samples& samples) {
  std::vector<MisreadPoses> all = {{"poses-inverted", "under the inverse of each pose",
                                    [](const Pose& pose) { return Pose(pose.inverse()); },
                                    "--pose-format inverse"}};
  if (!have_quaternions(samples)) return all;
  for (const bool w_first : {true, false}) {
    if (w_first == samples.has_viewpoints()) continue;
    all.push_back(
        {"quaternion-order",
         w_first ? "if quaternions are read as w x y z" : "if quaternions are read as x y z w",
         [w_first](const Pose& pose) {
           return with_rotation(pose, reordered_quaternion(pose.linear(), w_first));
         },
         w_first ? "--pose-format euroc" : "--pose-format tum"});
  }
  return all;
}

std::vector<PoseHypothesis> pose_hypotheses(Samples& samples) {
  const auto& poses = samples.poses();
  const std::size_t last = poses.size() - 1;
  std::vector<PoseHypothesis> all;
  add_frame_hypotheses(poses, camera_of(samples), all);
  add_world_hypotheses(samples, all);
  if (are_too_fast(poses)) {
    all.push_back(
        {"poses-in-millimetres", "if positions are divided by 1,000", [&poses](std::size_t i) {
           Pose pose = poses[i];
           pose.translation() *= 0.001;
           return pose;
         }});
  }
  const Pose T_body_sensor = samples.sequence().T_body_sensor.value_or(Pose::Identity());
  for (const MisreadPoses& read : misread_poses(samples)) {
    all.push_back({read.check, read.phrase, [read, &poses, T_body_sensor](std::size_t i) {
                     return Pose(read.right(poses[i] * T_body_sensor.inverse()) * T_body_sensor);
                   }});
  }
  all.push_back({"poses-shifted", "if each scan takes the pose of the scan after it",
                 [&poses, last](std::size_t i) { return poses[std::min(i + 1, last)]; }});
  all.push_back({"poses-shifted", "if each scan takes the pose of the scan before it",
                 [&poses](std::size_t i) { return poses[i == 0 ? 0 : i - 1]; }});
  return all;
}

}  // namespace raymoval::inspection
