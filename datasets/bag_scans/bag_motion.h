// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/records/record_source.h"
#include "datasets/trajectories/scan_poses.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// Which poses to read from a bag.
struct BagPoseQuery {
  std::string cloud_frame;                ///< Frame of the scans' points.
  std::uint64_t scans = 0;                ///< Messages of the topic with the scans.
  std::optional<std::string> pose_topic;  ///< As the user named it.
  std::optional<PointFrame> point_frame;  ///< As the user gave it.
  PoseSettings settings;
};

/// The sensor's motion in a bag.
struct BagMotion {
  std::shared_ptr<const SensorMotion> motion;
  std::string name;   ///< "/odom", or "tf map -> lidar".
  std::string where;  ///< For messages: "drive.bag: /odom".
  PointFrame point_frame = PointFrame::kSensor;
  std::vector<std::string> notes;
  std::vector<std::string> losses;  ///< Sentences on messages that could not be used.
};

/// Finds the motion of the sensor. Sources in order of preference: the named topic, the only topic
/// with odometry, the only topic with poses and at least one message per twenty scans, and tf from
/// the root to the frame of the points. If the poses are of another frame than the points, tf or
/// the user's sensor pose connects them. Points in the parent frame of the poses are in the world
/// frame.
/// @throws UsageError if there is no source or more than one, or if the pose of the sensor on the
///   body is unknown: each with the flag that helps. DataError if frames are mixed; UnreadableError
///   if the disk fails
BagMotion find_bag_motion(const Bag& bag, const BagPoseQuery& query);

}  // namespace raymoval
