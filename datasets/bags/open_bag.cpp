// SPDX-License-Identifier: MIT
#include "datasets/bags/open_bag.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/chunks/zstandard.h"
#include "datasets/bags/mcap/mcap_bag.h"
#include "datasets/bags/ros1/ros1_bag.h"
#include "datasets/bags/ros2/db3_bag.h"
#include "datasets/bags/ros2/folder_bag.h"
#include "datasets/bags/ros2/packed_bag.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Whether a name ends as those of recordings do.
bool has_bag_ending(const fs::path& path) {
  const fs::path ending = without_zstd_ending(path.filename()).extension();
  return ending == ".bag" || ending == ".mcap" || ending == ".db3" ||
         path.filename().string().ends_with(".bag.active");
}

std::unique_ptr<Bag> open_inside(const fs::path& file) {
  switch (container_of(file)) {
    case BagContainer::kRos1:
      return std::make_unique<Ros1Bag>(file);
    case BagContainer::kMcap:
      return std::make_unique<McapBag>(file);
    case BagContainer::kDb3:
      return std::make_unique<Db3Bag>(file);
    case BagContainer::kZstd:
      break;
  }
  throw UsageError(file.string() + ": is packed twice. Unpack it by `zstd --decompress`.");
}

std::unique_ptr<Bag> open_file(const fs::path& file) {
  if (container_of(file) != BagContainer::kZstd) return open_inside(file);
  return std::make_unique<PackedBag>(file, open_inside);
}

std::unique_ptr<Bag> open_in_folder(const fs::path& file) {
  if (container_of(file) != BagContainer::kRos1) return open_file(file);
  throw DataError(
      file.string() +
      ": is a bag of ROS 1, which metadata.yaml cannot describe. Name the file itself.");
}

std::unique_ptr<Bag> open_folder(const fs::path& folder) {
  if (has_file(folder / "metadata.yaml")) {
    return std::make_unique<Ros2FolderBag>(folder, open_in_folder);
  }
  std::vector<std::string> inside;
  for (const fs::path& entry : entries_of(folder)) {
    if (has_bag_ending(entry) && inside.size() < 5) inside.push_back(entry.filename().string());
  }
  if (inside.empty()) {
    throw DataError(folder.string() +
                    ": has no metadata.yaml and no .db3, .mcap or .bag file, so it is no "
                    "recording.");
  }
  throw UsageError(folder.string() +
                   ": has no metadata.yaml, which says what belongs to the "
                   "recording. Name one of its files (" +
                   join(inside) + "), or write it by `ros2 bag reindex " +
                   folder.filename().string() + "`.");
}

}  // namespace

BagContainer container_of(const fs::path& file) {
  if (file.filename().string().ends_with(".bag.active")) {
    throw UsageError(file.string() +
                     ": is a recording that was not closed, or is being written. Copy it to a name "
                     "that ends in .bag, `rosbag reindex` it, and name that.");
  }
  const std::string head = BagFile(file).read_up_to(0, 16);
  if (head.starts_with(kRos1Magic)) return BagContainer::kRos1;
  if (head.starts_with("#ROSBAG V1") || head.starts_with("#ROSLOG V1")) {
    throw UsageError(file.string() + ": is a bag of version " + head.substr(9, 3) +
                     ", from before 2010; only 2.0 is read. `rosbag fix` writes it anew.");
  }
  if (head.starts_with(kMcapMagic)) return BagContainer::kMcap;
  if (head.starts_with("SQLite format 3")) return BagContainer::kDb3;
  if (is_zstd(head)) return BagContainer::kZstd;
  throw DataError(
      file.string() +
      ": does not begin as a recording does (a ROS 1 bag, MCAP, a database of SQLite, or "
      "one of these packed by zstd); it is damaged or something else. Copy it again.");
}

std::unique_ptr<Bag> open_any_bag(const fs::path& path) {
  return is_folder(path) ? open_folder(without_slash(path)) : open_file(path);
}

bool is_bag(const fs::path& path) {
  if (is_folder(path)) return if_whole([&] { return has_file(path / "metadata.yaml"); }) == true;
  return has_bag_ending(path) && is_file(path);
}

std::unique_ptr<Bag> open_bag(const fs::path& path) {
  std::unique_ptr<Bag> bag = open_any_bag(path);
  const auto& topics = bag->topics();
  const bool has_any = std::any_of(topics.begin(), topics.end(),
                                   [](const BagTopic& topic) { return topic.messages > 0; });
  if (has_any) return bag;
  throw DataError(path.string() + ": holds no message that can be read. " +
                  join(bag->damage(), " ") + " Copy it again, or name another recording.");
}

}  // namespace raymoval
