// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/bag_motion.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bag_scans/frame_tree.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/messages/pose_messages.h"
#include "datasets/trajectories/scan_poses.h"

namespace raymoval {
namespace {

constexpr const char* kOdometry = "nav_msgs/Odometry";
constexpr const char* kPath = "nav_msgs/Path";
constexpr const char* kPoseOption = "--pose-topic";

/// The poses of a topic, all between the same two frames.
struct TopicPoses {
  std::string frame, child;
  Trajectory trajectory;
  std::vector<std::string> notes, losses;
};

class TopicPosesReader {
 public:
  TopicPosesReader(const Bag& bag, std::size_t topic) : bag_(bag), topic_(topic) {}

  TopicPoses read() {
    const bool path = bag_.topics()[topic_].type == kPath;
    for_each_pose_message(bag_, topic_, skipped_, [&](std::size_t message, auto&& poses) {
      // Each path repeats the one before, corrected, with a pose more.
      if (path && !poses.empty()) stamped_.clear();
      for (PoseMessage& pose : poses) {
        if (pose.stamp == 0 && !path) {
          pose.stamp = bag_.recorded(topic_, message);
          ++unstamped_;
        }
        add(pose, message_place(bag_, topic_, message));
      }
    });
    finish();
    return std::move(result_);
  }

 private:
  void add(const PoseMessage& pose, const std::string& place) {
    if (std::exchange(any_, true)) {
      check_frame(result_.frame, pose.frame, "frame_id", place);
      check_frame(result_.child, pose.child, "child_frame_id", place);
    }
    result_.frame = pose.frame;
    result_.child = pose.child;
    try {
      stamped_.push_back({pose.stamp, rigid_pose(pose, place)});
    } catch (const DataError& error) {
      skipped_.add(error.what());
    }
  }

  static void check_frame(const std::string& before, const std::string& now, const char* field,
                          const std::string& place) {
    if (before == now) return;
    throw DataError(place + ": its " + field + " is '" + now + "', that of earlier messages '" +
                    before +
                    "'; a trajectory has one frame. Filter the bag to one frame, or give the poses "
                    "as a file (--poses).");
  }

  void finish() {
    const std::string where = bag_name(bag_) + ": " + bag_.topics()[topic_].name + ": ";
    const std::string skipped = skipped_.sentence();
    if (stamped_.empty()) {
      throw DataError(where + "holds no pose that can be used." +
                      (skipped.empty() ? "" : " " + skipped));
    }
    if (!skipped.empty()) result_.losses.push_back(where + skipped);
    if (unstamped_ > 0) {
      result_.notes.push_back(where + counted_text(unstamped_, "message") +
                              " without a stamp; the time of recording is used.");
    }
    result_.trajectory = ordered_trajectory(std::move(stamped_));
  }

  const Bag& bag_;
  std::size_t topic_;
  TopicPoses result_;
  std::vector<StampedPose> stamped_;
  SkippedMessages skipped_;
  std::size_t unstamped_ = 0;
  bool any_ = false;
};

/// The steps from the body that has the poses to the sensor.
std::vector<MotionStep> body_to_sensor(const Bag& bag, const TopicPoses& poses,
                                       const BagPoseQuery& query, BagMotion& result) {
  const auto fixed = [](const Pose& pose) { return std::vector<MotionStep>{{{}, pose}}; };
  if (query.settings.T_body_sensor) return fixed(*query.settings.T_body_sensor);
  if (result.point_frame == PointFrame::kWorld || poses.child == query.cloud_frame) return {};
  if (poses.child.empty()) {
    result.notes.push_back(
        result.where +
        ": its poses name no child frame and are used as those of the sensor. If they are those of "
        "a body, give the pose of the sensor on it with --T-sensor.");
    return {};
  }
  const FrameTree tree(bag);
  auto links = tree.links(poses.child, query.cloud_frame);
  if (!links) {
    throw UsageError(result.where + ": the poses are of frame '" + poses.child +
                     "', the points in frame '" + query.cloud_frame +
                     "', and the bag has no transform between them. Give it with --T-sensor "
                     "x,y,z,qx,qy,qz,qw, the pose of the sensor in '" +
                     poses.child + "' (0,0,0,0,0,0,1 if they are the same).");
  }
  result.notes.push_back(result.where + ": the poses are of frame '" + poses.child +
                         "'; the pose of the sensor in it ('" + query.cloud_frame +
                         "') is taken from tf.");
  for (std::string& loss : tree.losses()) result.losses.push_back(std::move(loss));
  return *links;
}

BagMotion motion_of_topic(const Bag& bag, std::size_t topic, const BagPoseQuery& query) {
  BagMotion result;
  result.name = bag.topics()[topic].name;
  result.where = bag_name(bag) + ": " + result.name;
  TopicPoses poses = TopicPosesReader(bag, topic).read();
  result.notes = poses.notes;
  result.losses = poses.losses;
  const bool in_world =
      !query.cloud_frame.empty() && query.cloud_frame == poses.frame && poses.child != poses.frame;
  result.point_frame =
      query.point_frame.value_or(in_world ? PointFrame::kWorld : PointFrame::kSensor);
  if (in_world && !query.point_frame) {
    result.notes.push_back(result.where + ": the points are in frame '" + poses.frame +
                           "', the world frame of its poses: the poses are already applied. If "
                           "they are not, use --points sensor.");
  }
  std::vector<MotionStep> links = body_to_sensor(bag, poses, query, result);
  links.insert(links.begin(), {std::move(poses.trajectory)});
  result.motion = std::make_shared<SensorMotion>(std::move(links), query.settings.time_offset,
                                                 query.settings.max_gap);
  return result;
}

[[noreturn]] void throw_no_poses(const Bag& bag, const std::string& why) {
  throw UsageError(bag.path().string() + ": there are no poses. " + why + " " +
                   topics_sentence(bag) + " Name a topic with poses with --pose-topic. " +
                   ways_to_poses());
}

BagMotion motion_of_tf(const Bag& bag, const BagPoseQuery& query) {
  const FrameTree tree(bag);
  const std::string frame = "'" + query.cloud_frame + "'";
  if (!tree.knows(query.cloud_frame)) {
    throw_no_poses(bag, tree.empty() ? "No topic has odometry, poses or tf."
                                     : "tf has no frame of the points, " + frame + ".");
  }
  if (query.settings.T_body_sensor) {
    throw UsageError(
        bag_name(bag) +
        ": --T-sensor is the pose of the sensor on a body, but the poses are from tf, which has "
        "the frame of the sensor. Leave it out, or name the poses with --pose-topic or --poses.");
  }
  const std::vector<std::string> chain = tree.chain(query.cloud_frame);
  const bool dynamic = std::any_of(chain.begin(), chain.end() - 1,
                                   [&](const std::string& name) { return tree.is_dynamic(name); });
  if (!dynamic) {
    throw_no_poses(bag, "tf has only a fixed transform of the frame of the points, " + frame +
                            ", in '" + chain.back() + "', and no motion of that frame.");
  }
  BagMotion result;
  result.name = "tf " + chain.back() + " -> " + query.cloud_frame;
  result.where = bag_name(bag) + ": " + result.name;
  result.point_frame = query.point_frame.value_or(PointFrame::kSensor);
  result.motion =
      std::make_shared<SensorMotion>(*tree.links(chain.back(), query.cloud_frame),
                                     query.settings.time_offset, query.settings.max_gap);
  result.losses = tree.losses();
  return result;
}

}  // namespace

BagMotion find_bag_motion(const Bag& bag, const BagPoseQuery& query) {
  const auto is_usual = [&](const BagTopic& topic) {
    // A goal or a first guess is a pose, too, but one that hardly ever comes.
    const bool enough = topic.type == kPath || topic.messages * 20 >= query.scans;
    return has_poses(topic.type) && !is_tf(topic.type) && enough;
  };
  const TopicRequest named{kPoseOption, "with poses",
                           [](const BagTopic& topic) { return has_poses(topic.type); }};
  const TopicRequest odometry{kPoseOption, "with odometry",
                              [](const BagTopic& topic) { return topic.type == kOdometry; }};
  const TopicRequest poses{kPoseOption, "with poses", is_usual};
  std::optional<std::size_t> topic;
  if (query.pose_topic) {
    topic = choose_topic(bag, query.pose_topic, named);
  } else {
    topic = choose_topic(bag, std::nullopt, odometry);
    if (!topic) topic = choose_topic(bag, std::nullopt, poses);
  }
  if (!topic || is_tf(bag.topics()[*topic].type)) return motion_of_tf(bag, query);
  return motion_of_topic(bag, *topic, query);
}

}  // namespace raymoval
