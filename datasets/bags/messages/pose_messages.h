// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/bags/messages/message_reader.h"

namespace raymoval {

/// A pose or a transform of a message, as it stands there.
struct PoseMessage {
  Nanoseconds stamp = 0;
  std::string frame;  ///< The frame that the pose is told in: header.frame_id.
  std::string child;  ///< The frame that has the pose: child_frame_id; empty if nothing says it.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// Whether `type` holds poses: nav_msgs/Odometry and Path, geometry_msgs/PoseStamped,
/// PoseWithCovarianceStamped and TransformStamped, tf2_msgs/TFMessage (and tf/tfMessage).
bool has_poses(const std::string& type);
/// Whether `type` holds any number of transforms between many frames: tf2_msgs/TFMessage.
bool is_tf(const std::string& type);

/// The poses of a message. Frames begin without "/", as tf2 has them.
/// @param where begins messages: "drive.bag: /odom, message 12"
/// @throws DataError naming the field that is cut; UsageError if `has_poses` does not hold
std::vector<PoseMessage> read_poses(std::string_view bytes, const std::string& type,
                                    MessageEncoding encoding, const std::string& where);

/// The rigid motion of a pose. @throws DataError if a number is not finite, or the quaternion is
/// not
///   of length 1 (within 0.01)
Pose rigid_pose(const PoseMessage& pose, const std::string& where);

/// A frame's name without the "/" that ROS 1's first tf wrote at its beginning.
std::string frame_name(std::string name);

}  // namespace raymoval
