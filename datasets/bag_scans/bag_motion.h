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

/// What is asked of the poses in a bag.
struct BagPoseQuery {
  std::string cloud_frame;                ///< Frame of the scans' points.
  std::uint64_t scans = 0;                ///< Messages of the topic with the scans.
  std::optional<std::string> pose_topic;  ///< The one that a user named.
  std::optional<PointFrame> point_frame;  ///< As a user said it.
  PoseSettings settings;
};

/// Where a bag says that the sensor was.
struct BagMotion {
  std::shared_ptr<const SensorMotion> motion;
  std::string name;   ///< "/odom", or "tf map -> lidar".
  std::string where;  ///< For messages: "drive.bag: /odom".
  PointFrame point_frame = PointFrame::kSensor;
  std::vector<std::string> notes;
  std::vector<std::string> losses;  ///< Sentences on messages that could not be used.
};

/// The motion of the sensor by what a bag holds. The topic is the one named, else the only one with
/// odometry, else the only one with poses that has a message for each twenty scans or more, else
/// the frames of tf from the root to the frame of the points. Poses of another frame than that of
/// the points go on by tf, or by what the user said of the sensor. Points in the frame that the
/// poses are told in stand in the world.
/// @throws UsageError if there is nothing of the kind, or several; if nothing says where the sensor
///   is on the body that has the poses: each with the flag that helps. DataError if frames are
///   mixed; UnreadableError if the disk fails
BagMotion find_bag_motion(const Bag& bag, const BagPoseQuery& query);

}  // namespace raymoval
