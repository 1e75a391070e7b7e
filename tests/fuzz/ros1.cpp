// SPDX-License-Identifier: MIT
// ROS 1 bags, and the messages in recordings of ROS 1 and ROS 2.
#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/bags/bag_formats.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/bags/messages/pose_messages.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

RAYMOVAL_FUZZ_TARGET(bag_ros1) {
  may_refuse([&] {
    const auto bag = open_ros1(input_file("drive.bag", bytes));
    for (std::size_t topic = 0; topic < bag->topics().size(); ++topic) {
      const std::uint64_t count = bag->topics()[topic].messages;
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, 100); ++i) {
        require(i == 0 || bag->recorded(topic, i) >= bag->recorded(topic, i - 1),
                "messages are not in the order of their times");
        may_refuse([&] {
          const std::string message = bag->message(topic, i);
          require(message.starts_with(bag->message_head(topic, i, 16)),
                  "a message has another beginning");
        });
      }
    }
    require(bag->damage().size() <= DamageNotes::kMost + 1, "there are too many notes on damage");
  });
}

/// The first byte of an input says the type of the message, the second how it is written.
RAYMOVAL_FUZZ_TARGET(bag_message) {
  const std::array<std::string, 7> types = {
      "sensor_msgs/PointCloud2", "livox_ros_driver/CustomMsg", "nav_msgs/Odometry",
      "nav_msgs/Path",           "geometry_msgs/PoseStamped",  "geometry_msgs/TransformStamped",
      "tf2_msgs/TFMessage"};
  if (bytes.size() < 2) return;
  const std::string& type = types[static_cast<unsigned char>(bytes[0]) % types.size()];
  const MessageEncoding encoding =
      bytes[1] % 2 == 0 ? MessageEncoding::kRos1 : MessageEncoding::kCdr;
  const std::string_view message = bytes.substr(2);
  may_refuse([&] {
    if (has_poses(type)) {
      for (const PoseMessage& pose : read_poses(message, type, encoding, "m")) {
        may_refuse([&] {
          const Eigen::Matrix3d turn = rigid_pose(pose, "m").linear();
          require((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() < 1e-9,
                  "a pose is not rigid");
        });
      }
      return;
    }
    const PointRecords points = read_points(message, type, encoding, "m");
    require(points.bytes.size() <= message.size() && points.size() <= message.size(),
            "there are more points than bytes");
  });
}

}  // namespace
}  // namespace raymoval::fuzz
