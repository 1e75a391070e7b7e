// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/messages/pose_messages.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// Sorts poses by time. Of several poses with one stamp the last is kept, as in tf.
Trajectory ordered_trajectory(std::vector<StampedPose> poses);

/// Counts messages that could not be used, and summarises them in one sentence.
class SkippedMessages {
 public:
  /// @param reason why the message could not be used, with its place
  void add(const std::string& reason);
  /// "3 messages of /tf could not be read, the first: ..." Empty if there is none.
  [[nodiscard]] std::string sentence() const;

 private:
  std::size_t count_ = 0;
  std::string first_;
};

/// The poses of all messages of a topic, one message after another. Messages that cannot be read
/// are skipped. @throws UnreadableError if the disk fails
void for_each_pose_message(
    const Bag& bag, std::size_t topic, SkippedMessages& skipped,
    const std::function<void(std::size_t message, std::vector<PoseMessage>&&)>& call);

/// The frames of a recording from tf and tf_static. Each frame has a parent and a pose in it, which
/// is fixed or changes over time. A transform of tf_static holds at all times, also before its
/// message. A transform of tf holds over the time span of its messages, even if all are equal. Only
/// the parents are kept in memory.
class FrameTree {
 public:
  /// Reads all tf topics. @throws UnreadableError
  explicit FrameTree(const Bag& bag);

  [[nodiscard]] bool empty() const { return edges_.empty(); }
  [[nodiscard]] bool knows(const std::string& frame) const;
  /// `frame`, its parent, the parent's parent and so on up to the root.
  /// @throws DataError if the frames form a cycle, or a frame has two parents
  [[nodiscard]] std::vector<std::string> chain(const std::string& frame) const;
  /// Whether the pose of `frame` in its parent may change: it is not from tf_static.
  [[nodiscard]] bool is_dynamic(const std::string& frame) const;
  /// The steps from frame `from` to frame `to`: their product is T_from_to. Reads the transforms on
  /// the way. Empty if no chain of frames connects them.
  /// @throws DataError as `chain`, and if a fixed transform, or every message of a changing one, is
  ///   no rigid motion
  [[nodiscard]] std::optional<std::vector<MotionStep>> links(const std::string& from,
                                                             const std::string& to) const;
  /// The pose in `frame` of each frame that a chain of fixed transforms connects with it.
  [[nodiscard]] std::map<std::string, Pose> fixed_frames(const std::string& frame) const;
  /// Sentences on messages that could not be used.
  [[nodiscard]] std::vector<std::string> losses() const;

 private:
  struct Edge {
    std::string parent, other_parent;  ///< The second is empty unless the frame has two parents.
    bool dynamic = false;              ///< From tf.
    PoseMessage last;
  };
  void add(const PoseMessage& pose, bool dynamic);
  void read_links(std::map<std::string, MotionStep>& links) const;

  const Bag& bag_;
  std::vector<std::size_t> topics_;
  std::map<std::string, Edge> edges_;  ///< By the child's name.
  mutable SkippedMessages skipped_;
};

}  // namespace raymoval
