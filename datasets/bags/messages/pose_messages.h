// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/bags/messages/message_reader.h"

namespace raymoval {

/// A pose or a transform of a message, unchanged.
struct PoseMessage {
  Nanoseconds stamp = 0;
  std::string frame;  ///< The parent frame: header.frame_id.
  std::string child;  ///< The frame that has the pose: child_frame_id; empty if missing.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// Whether `type` holds poses: nav_msgs/Odometry and Path, geometry_msgs/PoseStamped,
/// PoseWithCovarianceStamped and TransformStamped, tf2_msgs/TFMessage (and tf/tfMessage).
bool has_poses(const std::string& type);
/// Whether `type` holds any number of transforms between many frames: tf2_msgs/TFMessage.
bool is_tf(const std::string& type);

/// The poses of a message. Frames have no leading "/", as in tf2.
/// @param where begins messages: "drive.bag: /odom, message 12"
/// @throws DataError naming the field that is truncated; UsageError if `has_poses` is false
std::vector<PoseMessage> read_poses(std::string_view bytes, const std::string& type,
                                    MessageEncoding encoding, const std::string& where);

/// The rigid motion of a pose.
/// @throws DataError if a number is not finite, or the length of the quaternion is not 1 +- 0.01
Pose rigid_pose(const PoseMessage& pose, const std::string& where);

/// A frame's name without the leading "/" of ROS 1's first tf.
std::string frame_name(std::string name);

}  // namespace raymoval
