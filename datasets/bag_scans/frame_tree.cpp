// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/frame_tree.h"

#include <algorithm>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/bag_index.h"

namespace raymoval {

Trajectory ordered_trajectory(std::vector<StampedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  std::vector<StampedPose> ordered;
  for (const StampedPose& pose : poses) {
    if (!ordered.empty() && ordered.back().stamp == pose.stamp) ordered.pop_back();
    ordered.push_back(pose);
  }
  return Trajectory(std::move(ordered));
}

namespace {

bool is_static_topic(const BagTopic& topic) {
  return topic.name.ends_with("tf_static");
}

}  // namespace

void SkippedMessages::add(const std::string& reason) {
  if (count_++ == 0) first_ = reason;
}

std::string SkippedMessages::sentence() const {
  if (count_ == 0) return "";
  return counted_text(count_, "message") +
         " could not be used, the first for this reason: " + first_;
}

void for_each_pose_message(
    const Bag& bag, std::size_t topic, SkippedMessages& skipped,
    const std::function<void(std::size_t message, std::vector<PoseMessage>&&)>& call) {
  const BagTopic& of = bag.topics()[topic];
  for (std::size_t i = 0; i < of.messages; ++i) {
    std::vector<PoseMessage> poses;
    const std::string damage = damage_in([&] {
      poses = read_poses(bag.message(topic, i), of.type, of.encoding, message_place(bag, topic, i));
    });
    if (damage.empty()) {
      call(i, std::move(poses));
    } else {
      skipped.add(damage);
    }
  }
}

FrameTree::FrameTree(const Bag& bag) : bag_(bag) {
  for (std::size_t topic = 0; topic < bag.topics().size(); ++topic) {
    if (!is_tf(bag.topics()[topic].type)) continue;
    topics_.push_back(topic);
    const bool dynamic = !is_static_topic(bag.topics()[topic]);
    for_each_pose_message(bag, topic, skipped_, [&](std::size_t, auto&& poses) {
      for (const PoseMessage& pose : poses) add(pose, dynamic);
    });
  }
}

void FrameTree::add(const PoseMessage& pose, bool dynamic) {
  const auto [found, is_new] = edges_.try_emplace(pose.child);
  Edge& edge = found->second;
  if (is_new) {
    edge.parent = pose.frame;
  } else if (pose.frame != edge.parent) {
    edge.other_parent = pose.frame;
    return;
  }
  edge.dynamic = edge.dynamic || dynamic;
  edge.last = pose;
}

bool FrameTree::knows(const std::string& frame) const {
  return edges_.contains(frame) || std::any_of(edges_.begin(), edges_.end(), [&](const auto& edge) {
           return edge.second.parent == frame;
         });
}

bool FrameTree::is_dynamic(const std::string& frame) const {
  const auto found = edges_.find(frame);
  return found != edges_.end() && found->second.dynamic;
}

std::vector<std::string> FrameTree::chain(const std::string& frame) const {
  const std::string where = bag_name(bag_) + ": tf: ";
  std::vector<std::string> frames = {frame};
  for (auto found = edges_.find(frame); found != edges_.end(); found = edges_.find(frames.back())) {
    const Edge& edge = found->second;
    if (!edge.other_parent.empty()) {
      throw DataError(
          where + "frame " + frames.back() + " has two parents, " + edge.parent + " and " +
          edge.other_parent +
          "; expected one. Name a topic with poses (--pose-topic), or a file (--poses).");
    }
    if (std::find(frames.begin(), frames.end(), edge.parent) != frames.end()) {
      throw DataError(
          where + "frame " + edge.parent +
          " is its own ancestor. Name a topic with poses (--pose-topic), or a file (--poses).");
    }
    frames.push_back(edge.parent);
  }
  return frames;
}

std::optional<std::vector<MotionStep>> FrameTree::links(const std::string& from,
                                                        const std::string& to) const {
  std::vector<std::string> down = chain(to), up = chain(from);
  if (down.back() != up.back()) return std::nullopt;
  // Ancestors of both frames are left out.
  while (down.size() > 1 && up.size() > 1 && down[down.size() - 2] == up[up.size() - 2]) {
    down.pop_back();
    up.pop_back();
  }
  down.pop_back();
  up.pop_back();
  std::map<std::string, MotionStep> found;
  for (const std::string& frame : up) found[frame].inverse = true;
  for (const std::string& frame : down) found[frame].inverse = false;
  read_links(found);
  std::vector<MotionStep> links;
  for (const std::string& frame : up) links.push_back(std::move(found[frame]));
  for (auto frame = down.rbegin(); frame != down.rend(); ++frame) {
    links.push_back(std::move(found[*frame]));
  }
  return links;
}

/// Fills in the transforms of the frames in `links`.
void FrameTree::read_links(std::map<std::string, MotionStep>& links) const {
  std::map<std::string, std::vector<StampedPose>> moving;
  const std::string where = bag_name(bag_) + ": tf";
  for (auto& [frame, link] : links) {
    const Edge& edge = edges_.at(frame);
    if (edge.dynamic) {
      moving[frame] = {};
    } else {
      link.fixed = rigid_pose(edge.last, where);
    }
  }
  if (moving.empty()) return;
  for (const std::size_t topic : topics_) {
    if (is_static_topic(bag_.topics()[topic])) continue;
    for_each_pose_message(bag_, topic, skipped_, [&](std::size_t message, auto&& poses) {
      for (const PoseMessage& pose : poses) {
        const auto found = moving.find(pose.child);
        if (found == moving.end()) continue;
        const std::string place = message_place(bag_, topic, message);
        const auto rigid = if_whole([&] { return rigid_pose(pose, place); });
        if (rigid) {
          found->second.push_back({pose.stamp, *rigid});
        } else {
          skipped_.add(place + ": the pose of " + pose.child + " is not a rigid motion.");
        }
      }
    });
  }
  for (auto& [frame, poses] : moving) {
    if (poses.empty()) {
      throw DataError(where + ": no pose of frame " + frame + " in " + edges_.at(frame).parent +
                      " can be used. " + skipped_.sentence() +
                      " Name a topic with poses (--pose-topic), or a file (--poses).");
    }
    links[frame].moving = ordered_trajectory(std::move(poses));
  }
}

std::map<std::string, Pose> FrameTree::fixed_frames(const std::string& frame) const {
  const std::string where = bag_name(bag_) + ": tf";
  std::map<std::string, Pose> found = {{frame, Pose::Identity()}};
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& [child, edge] : edges_) {
      const bool knows_child = found.count(child) != 0,
                 knows_parent = found.count(edge.parent) != 0;
      if (edge.dynamic || knows_child == knows_parent) continue;
      const auto T_parent_child = if_whole([&] { return rigid_pose(edge.last, where); });
      if (!T_parent_child) continue;
      if (knows_parent) {
        found[child] = found[edge.parent] * *T_parent_child;
      } else {
        found[edge.parent] = found[child] * T_parent_child->inverse();
      }
      grew = true;
    }
  }
  found.erase(frame);
  return found;
}

std::vector<std::string> FrameTree::losses() const {
  const std::string sentence = skipped_.sentence();
  if (sentence.empty()) return {};
  return {bag_name(bag_) + ": tf: " + sentence};
}

}  // namespace raymoval
