// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/pose_messages.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// How the messages of a type hold their poses.
struct Kind {
  const char* type;
  bool many;       ///< A sequence of stamped poses.
  bool of_header;  ///< A header precedes the sequence or the pose.
  bool has_child;  ///< child_frame_id follows each header.
};

constexpr std::array kKinds = {Kind{"nav_msgs/Odometry", false, true, true},
                               Kind{"nav_msgs/Path", true, true, false},
                               Kind{"geometry_msgs/PoseStamped", false, true, false},
                               Kind{"geometry_msgs/PoseWithCovarianceStamped", false, true, false},
                               Kind{"geometry_msgs/TransformStamped", false, true, true},
                               Kind{"tf2_msgs/TFMessage", true, false, true},
                               Kind{"tf/tfMessage", true, false, true}};

const Kind* kind_of(const std::string& type) {
  for (const Kind& kind : kKinds) {
    if (type == kind.type) return &kind;
  }
  return nullptr;
}

/// A position and a quaternion x y z w: the form of poses and of transforms.
void read_motion(MessageReader& reader, PoseMessage& pose) {
  for (int i = 0; i < 3; ++i) pose.position[i] = reader.number<double>("position");
  for (int i = 0; i < 4; ++i) pose.attitude.coeffs()[i] = reader.number<double>("orientation");
}

PoseMessage read_stamped(MessageReader& reader, bool has_child) {
  const MessageHeader header = read_message_header(reader);
  PoseMessage pose;
  pose.stamp = header.stamp;
  pose.frame = frame_name(header.frame_id);
  if (has_child) pose.child = frame_name(reader.text("child_frame_id"));
  read_motion(reader, pose);
  return pose;
}

}  // namespace

bool has_poses(const std::string& type) {
  return kind_of(type) != nullptr;
}

bool is_tf(const std::string& type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}

std::string frame_name(std::string name) {
  while (name.starts_with('/')) name.erase(0, 1);
  return name;
}

std::vector<PoseMessage> read_poses(std::string_view bytes, const std::string& type,
                                    MessageEncoding encoding, const std::string& where) {
  // A header (its stamp and the length of its frame) and seven numbers.
  constexpr std::size_t kLeastPose = 12 + 7 * sizeof(double);
  const Kind* kind = kind_of(type);
  if (kind == nullptr) throw UsageError(where + ": is of type " + type + ", which has no poses.");
  MessageReader reader(bytes, encoding, where);
  std::vector<PoseMessage> poses;
  if (!kind->many) {
    poses.push_back(read_stamped(reader, kind->has_child));
    return poses;
  }
  if (kind->of_header) (void)read_message_header(reader);
  const std::uint32_t count = reader.count("poses", kLeastPose);
  for (std::uint32_t i = 0; i < count; ++i) poses.push_back(read_stamped(reader, kind->has_child));
  return poses;
}

Pose rigid_pose(const PoseMessage& message, const std::string& where) {
  constexpr double kMostOff = 0.01;
  const double length = message.attitude.norm();
  if (!message.position.allFinite() || !(std::abs(length - 1.0) <= kMostOff)) {
    throw DataError(where + ": a pose of " + (message.child.empty() ? "no name" : message.child) +
                    " in " + message.frame +
                    " is not a rigid motion: its position is not finite, or its quaternion has "
                    "length " +
                    number_text(length) + " in place of 1.");
  }
  Pose pose = Pose::Identity();
  pose.translation() = message.position;
  pose.linear() = message.attitude.normalized().toRotationMatrix();
  return pose;
}

}  // namespace raymoval
