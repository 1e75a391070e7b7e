// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bag_scans/bag_motion.h"
#include "datasets/bag_scans/bag_source.h"
#include "datasets/bag_scans/frame_tree.h"
#include "datasets/bag_scans/indexed_labels.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/bag.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/bags/messages/pose_messages.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/returns.h"
#include "datasets/records/point_records.h"
#include "datasets/settings.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/scan_poses.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

template <class Value>
void take(std::vector<Value>& all, std::vector<Value> more) {
  for (Value& value : more) all.push_back(std::move(value));
}

/// The headers of the messages of a topic with scans.
struct ScanHeads {
  std::size_t topic = 0;
  std::vector<std::size_t> messages;  ///< Numbers of the usable messages, in order.
  std::vector<Nanoseconds> stamps;    ///< Of each usable message.
  /// The layout of the points of each usable message; equal layouts are shared.
  std::vector<std::shared_ptr<const RecordLayout>> layouts;
  Nanoseconds first_stamp = 0;      ///< Of the topic's first usable message.
  std::string frame;                ///< Frame of all points.
  FrameRange range;                 ///< As used, with both ends.
  std::vector<std::string> losses;  ///< Whole sentences on messages that are left out.
};

/// Messages that are left out, by the reason.
struct LeftOut {
  std::size_t empty = 0, damaged = 0;
  std::string first_damage;

  [[nodiscard]] std::size_t all() const { return empty + damaged; }
  [[nodiscard]] std::string text() const {
    std::vector<std::string> parts;
    if (empty > 0) parts.push_back(grouped_text(empty) + " without a point");
    if (damaged > 0) {
      parts.push_back(grouped_text(damaged) + " that cannot be read, the first: " + first_damage);
    }
    return join(parts);
  }
};

class HeadReader {
 public:
  HeadReader(const Bag& bag, std::size_t topic) : bag_(bag), topic_(topic) {}

  /// Empty if the message is left out; `left_out` counts it.
  std::optional<PointsHead> read(std::size_t message, LeftOut& left_out) const {
    try {
      PointsHead head = head_of(message);
      if (head.header.stamp == 0) head.header.stamp = bag_.recorded(topic_, message);
      if (head.size > 0) return head;
      ++left_out.empty;
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      if (left_out.damaged++ == 0) left_out.first_damage = error.what();
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] PointsHead head_of(std::size_t message) const {
    const BagTopic& topic = bag_.topics()[topic_];
    const std::string place = message_place(bag_, topic_, message);
    const auto read = [&](const std::string& bytes) {
      return read_points_head(bytes, topic.type, topic.encoding, place);
    };
    const std::string begin = bag_.message_head(topic_, message, kHeaderBytes);
    if (begin.size() < kHeaderBytes) return read(begin);
    if (auto head = if_whole([&] { return read(begin); })) return *std::move(head);
    return read(bag_.message(topic_, message));
  }

  const Bag& bag_;
  std::size_t topic_;
};

/// The numbers of messages that `range` chooses.
ChosenFrames choose_messages(const Bag& bag, std::size_t topic, const FrameRange& range) {
  std::vector<NumberedFile> all;
  for (std::uint64_t i = 0; i < bag.topics()[topic].messages; ++i) {
    all.push_back({static_cast<long>(i), {}});
  }
  return choose_frames(all, range, bag_name(bag) + ": " + bag.topics()[topic].name);
}

/// Reads the headers of the messages that `range` chooses. Messages without a point and unreadable
/// messages are left out. A message without a stamp gets the time at which it was recorded.
/// @throws DataError if the range reaches outside the topic, if half of the messages or more cannot
///   be used, or if their frames differ; Cancelled; UnreadableError if the disk fails
ScanHeads read_scan_heads(const Bag& bag, std::size_t topic, const FrameRange& range,
                          const std::atomic<bool>* cancel) {
  const HeadReader reader(bag, topic);
  const ChosenFrames chosen = choose_messages(bag, topic, range);
  ScanHeads heads;
  heads.topic = topic;
  heads.range = chosen.range;
  LeftOut left_out;
  for (const NumberedFile& file : chosen.files) {
    throw_if_cancelled(cancel);
    const auto message = static_cast<std::size_t>(file.number);
    const auto head = reader.read(message, left_out);
    if (!head) continue;
    if (heads.messages.empty()) {
      heads.frame = head->header.frame_id;
    } else if (head->header.frame_id != heads.frame) {
      throw DataError(message_place(bag, topic, message) + ": its points are in frame '" +
                      head->header.frame_id + "', those of earlier messages in '" + heads.frame +
                      "'; one sensor has one frame. Filter the bag to one frame.");
    }
    heads.messages.push_back(message);
    heads.stamps.push_back(head->header.stamp);
    const bool same = !heads.layouts.empty() && *heads.layouts.back() == head->layout;
    heads.layouts.push_back(same ? heads.layouts.back()
                                 : std::make_shared<const RecordLayout>(head->layout));
  }
  if (left_out.all() > 0) {
    heads.losses.push_back(bag_name(bag) + ": " + bag.topics()[topic].name + ": " +
                           counted_text(left_out.all(), "message") + " of " +
                           grouped_text(chosen.files.size()) + " left out: " + left_out.text());
    if (2 * left_out.all() >= chosen.files.size()) throw DataError(heads.losses.back());
  }
  LeftOut ignored;
  heads.first_stamp = heads.stamps.front();
  if (heads.messages.front() > 0) {
    if (const auto first = reader.read(0, ignored)) heads.first_stamp = first->header.stamp;
  }
  return heads;
}

/// A folder may have a sequence.json; a file has the options only.
SequenceSettings settings_of(const fs::path& path, const SequenceOptions& options) {
  if (is_folder(path)) return read_settings(path, options, {});
  SequenceSettings defaults;
  defaults.name = path.stem().string();
  return apply_options(options, defaults);
}

std::size_t scan_topic(const Bag& bag, const std::optional<std::string>& named) {
  const TopicRequest wish{"--topic", "with scans (sensor_msgs/PointCloud2 or a Livox CustomMsg)",
                          [](const BagTopic& topic) { return has_points(topic.type); }, true};
  if (const auto topic = choose_topic(bag, named, wish)) return *topic;
  throw UsageError(bag.path().string() +
                   ": no topic has scans, which are of type "
                   "sensor_msgs/PointCloud2 or livox_ros_driver/CustomMsg. " +
                   topics_sentence(bag) +
                   " To convert packets of a driver into clouds, replay the bag with the driver.");
}

/// The topics of `named`, between commas, or the only one.
std::vector<std::size_t> scan_topics(const Bag& bag, const std::optional<std::string>& named) {
  if (!named) return {scan_topic(bag, named)};
  std::vector<std::size_t> topics;
  for (const std::string_view name : split(*named, ',')) {
    const std::size_t topic = scan_topic(bag, std::string(name));
    if (std::find(topics.begin(), topics.end(), topic) != topics.end()) {
      throw UsageError(bag_name(bag) + ": --topic " + *named + ": names " +
                       bag.topics()[topic].name + " twice. Leave one of them out.");
    }
    topics.push_back(topic);
  }
  return topics;
}

/// Refuses topics whose points have one frame, because two sensors have not the same origin.
void check_frames(const Bag& bag, const std::vector<ScanHeads>& heads) {
  std::map<std::string, std::string> topics;
  for (const ScanHeads& of : heads) {
    const std::string& topic = bag.topics()[of.topic].name;
    const auto [other, is_new] = topics.emplace(frame_name(of.frame), topic);
    if (is_new) continue;
    throw UsageError(bag_name(bag) + ": the points of " + other->second + " and " + topic +
                     " are in one frame, '" + of.frame +
                     "', which cannot be the place of both sensors. Give each place in it: "
                     "--sensor-origin topic:0=X,Y,Z/1=X,Y,Z, in the order of --topic.");
  }
}

/// Takes the labels of the file beside the recording, if it is there.
void find_labels(const fs::path& folder, const SequenceSettings& settings, Sequence& sequence) {
  const fs::path file = folder / kIndexedLabelsFile;
  if (!has_file(file)) return;
  sequence.input_files.push_back(file);
  IndexedLabels found = read_indexed_labels(file, sequence.stamps);
  sequence.labels = std::move(found.labels);
  sequence.notes.push_back(std::move(found.note));
  if (!sequence.labels) return;
  sequence.label_rule = settings.label_rule_given ? with_unlabelled_ignored(sequence.label_rule)
                                                  : indexed_label_rule();
}

/// The poses of the scans, and where they are from.
struct FoundScanPoses {
  ScanPoses poses;
  std::string name;  ///< A file's name, a topic, or frames of tf.
  PointFrame point_frame = PointFrame::kSensor;
};

FoundScanPoses poses_of_file(const ScanHeads& heads, const BagTopic& topic,
                             const SequenceSettings& settings, const fs::path& folder,
                             const PoseSettings& pose_settings, Sequence& sequence) {
  ScanKeys keys;
  keys.rows = heads.messages;
  keys.row_count = topic.messages;
  keys.extent = counted_text(topic.messages, "message") + " of " + topic.name;
  keys.stamps = heads.stamps;
  for (const Nanoseconds stamp : heads.stamps) {
    keys.times_s.push_back(to_seconds(stamp - heads.first_stamp));
  }
  FoundScanPoses found;
  found.point_frame = settings.points.value_or(PointFrame::kSensor);
  found.name = kStationarySensor;
  if (settings.poses == kStationarySensor) {
    found.poses = stationary_poses(keys, pose_settings);
    return found;
  }
  const fs::path path = find_pose_file(folder, settings.poses);
  sequence.input_files.push_back(path);
  found.poses = scan_poses(read_pose_file(path, {settings.pose_format}), keys, pose_settings);
  found.name = path.filename().string();
  return found;
}

FoundScanPoses poses_of_bag(const Bag& bag, const ScanHeads& heads, std::uint64_t messages,
                            const SequenceSettings& settings,
                            const std::optional<std::string>& pose_topic,
                            const PoseSettings& pose_settings) {
  BagPoseQuery query;
  query.cloud_frame = frame_name(heads.frame);
  query.scans = messages;
  query.pose_topic = pose_topic;
  query.point_frame = settings.points;
  query.settings = pose_settings;
  BagMotion motion = find_bag_motion(bag, query);
  FoundPoses looked_up = look_up_poses(heads.stamps, *motion.motion, motion.where);
  FoundScanPoses found;
  found.name = motion.name;
  found.point_frame = motion.point_frame;
  found.poses.poses = std::move(looked_up.poses);
  found.poses.stamps = heads.stamps;
  found.poses.motion = motion.motion;
  found.poses.notes = std::move(motion.notes);
  found.poses.losses = std::move(motion.losses);
  take(found.poses.losses, std::move(looked_up.losses));
  found.poses.gap = std::move(looked_up.gap);
  return found;
}

/// Adds the poses of the scans of another topic to those of the first one. tf has the place of one
/// sensor beside the other.
void add_poses_beside(const Bag& bag, const ScanHeads& first, const ScanHeads& other,
                      ScanPoses& poses) {
  SensorMotion motion = *poses.motion;
  const std::string from = frame_name(first.frame), to = frame_name(other.frame);
  if (from != to) {
    const auto links = FrameTree(bag).links(from, to);
    if (!links) {
      throw UsageError(bag_name(bag) + ": tf has no transform between '" + from + "' and '" + to +
                       "', the frames of " + bag.topics()[first.topic].name + " and " +
                       bag.topics()[other.topic].name +
                       ", so the place of one sensor beside the other is unknown. Read the topics "
                       "one by one, each with the poses of its sensor (--poses, --T-sensor).");
    }
    motion = motion.followed_by(*links);
  }
  FoundPoses found =
      look_up_poses(other.stamps, motion, bag_name(bag) + ": " + bag.topics()[other.topic].name);
  take(poses.poses, std::move(found.poses));
  take(poses.stamps, other.stamps);
  take(poses.losses, std::move(found.losses));
  if (!poses.gap) poses.gap = std::move(found.gap);
}

/// The scans of all topics; several topics are sorted by time, and so are `poses`.
std::vector<BagScan> scans_of(const std::vector<ScanHeads>& heads, ScanPoses& poses) {
  std::vector<BagScan> scans;
  Nanoseconds begin = heads.front().first_stamp;
  for (const ScanHeads& of : heads) begin = std::min(begin, of.first_stamp);
  for (std::size_t k = 0; k < heads.size(); ++k) {
    const ScanHeads& of = heads[k];
    for (std::size_t i = 0; i < of.messages.size(); ++i) {
      scans.push_back({of.topic, of.messages[i], of.messages[i], k,
                       to_seconds(of.stamps[i] - begin), Pose::Identity(), of.layouts[i]});
    }
  }
  if (heads.size() == 1) return scans;
  std::vector<std::size_t> order(scans.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return poses.stamps[a] < poses.stamps[b]; });
  std::vector<BagScan> sorted;
  ScanPoses unsorted = poses;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.push_back(scans[order[i]]);
    sorted.back().number = i;
    poses.poses[i] = unsorted.poses[order[i]];
    poses.stamps[i] = unsorted.stamps[order[i]];
  }
  return sorted;
}

/// Removes the poses of messages whose points cannot be read.
void drop_bad_messages(const Bag& bag, const std::vector<BagScan>& scans,
                       const std::atomic<bool>* cancel, ScanPoses& poses) {
  const auto name = [&](std::size_t i) { return "message " + std::to_string(scans[i].message); };
  const auto read = [&](std::size_t i) {
    const BagTopic& of = bag.topics()[scans[i].topic];
    (void)read_points(bag.message(scans[i].topic, scans[i].message), of.type, of.encoding,
                      message_place(bag, scans[i].topic, scans[i].message));
  };
  drop_bad_scans(poses.poses, name, read, cancel, poses.losses);
}

/// Gives `sequence` the scans that have a pose.
void add_scans(const std::shared_ptr<const Bag>& bag, std::vector<BagScan> scans,
               const FoundScanPoses& found, const SequenceSettings& settings, std::size_t topics,
               Sequence& sequence) {
  std::vector<BagScan> placed;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!found.poses.poses[i]) continue;
    placed.push_back(std::move(scans[i]));
    placed.back().T_world_sensor = *found.poses.poses[i];
    if (topics > 1) sequence.topics.push_back(placed.back().sensor);
  }
  const auto source =
      std::make_shared<BagScanSource>(bag, std::move(placed), found.point_frame, settings.sensor);
  sequence.scans = source;
  sequence.records = source;
}

Sequence open_bag_sequence(Layout::Path text, const SequenceOptions& options,
                           const OpenContext& context) {
  const fs::path path = text;
  const SequenceSettings settings = settings_of(path, options);
  const fs::path folder = is_folder(path) ? path : folder_of(path);
  if (settings.poses && options.pose_topic) {
    throw UsageError(path.string() + ": poses are given both in " + *settings.poses +
                     " (--poses) and on the topic " + *options.pose_topic +
                     " (--pose-topic). Leave one of them out.");
  }
  const std::shared_ptr<const Bag> bag = open_bag(path);
  std::vector<ScanHeads> heads;
  std::vector<std::string> topics;
  FrameRange range;
  for (const std::size_t topic : scan_topics(*bag, options.topic)) {
    heads.push_back(read_scan_heads(*bag, topic, settings.frames, context.cancel));
    topics.push_back(topic_text(bag->topics()[topic]));
    if (range.last.value_or(-1) < heads.back().range.last) range = heads.back().range;
  }
  const ScanHeads& first = heads.front();
  if (!settings.sensor_origin) check_frames(*bag, heads);

  Sequence sequence = make_sequence(settings, bags_layout(), range);
  // No output file may overwrite the recording or a file of it.
  sequence.input_files.push_back(path);
  if (is_folder(path)) take(sequence.input_files, entries_of(path));
  const PoseSettings pose_settings =
      raymoval::pose_settings(settings, folder, sequence.input_files);
  sequence.T_body_sensor = pose_settings.T_body_sensor;
  const BagTopic& topic = bag->topics()[first.topic];
  FoundScanPoses found =
      settings.poses
          ? poses_of_file(first, topic, settings, folder, pose_settings, sequence)
          : poses_of_bag(*bag, first, topic.messages, settings, options.pose_topic, pose_settings);
  for (std::size_t k = 1; k < heads.size(); ++k) {
    add_poses_beside(*bag, first, heads[k], found.poses);
  }
  std::vector<BagScan> scans = scans_of(heads, found.poses);
  if (settings.skip_bad_scans) drop_bad_messages(*bag, scans, context.cancel, found.poses);
  sequence.fixed_frames = [bag, frame = frame_name(first.frame)] {
    std::map<std::string, Eigen::Vector3d> places;
    for (const auto& [name, pose] : FrameTree(*bag).fixed_frames(frame)) {
      places[name] = pose.translation();
    }
    return places;
  };
  sequence.poses_file = found.name;
  sequence.damage = bag->damage();
  sequence.notes.push_back(path.filename().string() + ": the scans are those of " + join(topics) +
                           ", the poses those of " + found.name + ".");
  for (ScanHeads& of : heads) take(sequence.losses, std::move(of.losses));
  add_poses(found.poses, sequence);
  find_labels(folder, settings, sequence);
  add_scans(bag, std::move(scans), found, settings, heads.size(), sequence);
  return sequence;
}

}  // namespace

Layout bags_layout() {
  Layout layout;
  layout.name = "bags";
  layout.expected = "a recording of ROS messages (.bag, .mcap, .db3, or the folder of ROS 2)";
  layout.forms = {{"FILE.bag", "a ROS 1 bag with clouds and poses (see --topic, --pose-topic)"},
                  {"FILE.mcap", "an MCAP file of ROS 1 or ROS 2"},
                  {"FILE.db3", "a database of ROS 2"},
                  {"FOLDER", "a recording of ROS 2 with its metadata.yaml"}};
  layout.expected_labels = std::string("a file ") + kIndexedLabelsFile +
                           " beside the recording with lines of these scans";
  layout.recognise = [](Layout::Path path) { return is_bag(path); };
  layout.open = open_bag_sequence;
  return layout;
}

}  // namespace raymoval
