// SPDX-License-Identifier: MIT
#include <sys/statvfs.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/scratch_folder.h"
#include "core/text.h"
#include "datasets/bags/bag.h"
#include "datasets/bags/bag_file.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/decompress.h"
#include "datasets/bags/mcap/mcap_file.h"
#include "datasets/bags/ros1/ros1_file.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Bytes of the disk that stay free for other programs.
constexpr std::uint64_t kSpare = std::uint64_t{64} << 20;

/// Number of bytes that may be written to `folder`.
std::uint64_t room_in(const fs::path& folder) {
  struct statvfs status {};
  if (::statvfs(folder.c_str(), &status) != 0) return 0;
  const std::uint64_t free = std::uint64_t{status.f_bavail} * status.f_frsize;
  return free - std::min(free, kSpare);
}

/// A recording in a file that Zstandard compressed as a whole. Opening it decompresses it to a
/// private folder.
class CompressedBag : public Bag {
 public:
  using Open = std::unique_ptr<Bag> (*)(const fs::path&);
  /// @throws DataError if the disk has no room for it, or if it decompresses to more than 1,000
  ///   times its bytes and 1 MiB; UnreadableError if the disk fails; the errors of `open` for the
  ///   file inside
  CompressedBag(const fs::path& path, Open open) : path_(path) {
    const BagFile packed(path);
    const fs::path copy = folder_.path() / without_zstd_ending(path.filename());
    const std::uint64_t counted = std::min(packed.size(), std::uint64_t{1} << 50U);
    const std::uint64_t most = std::min(room_in(folder_.path()), 1000 * counted + (1U << 20U));
    FileWriter writer(copy);
    problem_ =
        decompress_zstd_file(packed, most, [&](std::string_view piece) { writer.append(piece); });
    writer.commit();
    bag_ = open(copy);
  }

  [[nodiscard]] const fs::path& path() const override { return path_; }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return bag_->topics(); }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return bag_->recorded(topic, index);
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override {
    return bag_->message(topic, index);
  }
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override {
    return bag_->message_head(topic, index, most);
  }
  [[nodiscard]] std::vector<std::string> damage() const override {
    std::vector<std::string> all = bag_->damage();
    if (!problem_.empty()) {
      all.insert(all.begin(), path_.string() + ": " + problem_ + "; everything before it is read.");
    }
    return all;
  }

 private:
  fs::path path_;
  ScratchFolder folder_{kRecordingFolder};
  std::string problem_;  ///< Problem of the compressed file, such as a truncated end.
  std::unique_ptr<Bag> bag_;
};

/// The format of a file, by its first bytes.
enum class BagContainer { kRos1, kMcap, kDb3, kZstd };

/// A .bag.active, which was not closed, begins like other bags.
/// @throws DataError for an unknown beginning; UsageError for a known format that is not supported
BagContainer container_of(const fs::path& file) {
  const std::string head = BagFile(file).read_up_to(0, 16);
  if (head.starts_with(kRos1Magic)) return BagContainer::kRos1;
  if (head.starts_with("#ROSBAG V1") || head.starts_with("#ROSLOG V1")) {
    throw UsageError(file.string() + ": is a bag of version " + head.substr(9, 3) +
                     ", from before 2010; only 2.0 is read. `rosbag fix` rewrites it.");
  }
  if (head.starts_with(kMcapMagic)) return BagContainer::kMcap;
  if (head.starts_with("SQLite format 3")) return BagContainer::kDb3;
  if (is_zstd(head)) return BagContainer::kZstd;
  throw DataError(
      file.string() +
      ": does not begin as a recording does (a ROS 1 bag, MCAP, a database of SQLite, or one of "
      "these compressed by zstd); it is damaged or something else. Copy it again.");
}

/// Whether a name has the ending of a recording.
bool has_bag_ending(const fs::path& path) {
  const fs::path ending = without_zstd_ending(path.filename()).extension();
  return ending == ".bag" || ending == ".mcap" || ending == ".db3" ||
         path.filename().string().ends_with(".bag.active");
}

std::unique_ptr<Bag> open_inside(const fs::path& file) {
  switch (container_of(file)) {
    case BagContainer::kRos1:
      return open_ros1(file);
    case BagContainer::kMcap:
      return open_mcap(file);
    case BagContainer::kDb3:
      return open_db3(file);
    case BagContainer::kZstd:
      break;
  }
  throw UsageError(file.string() + ": is compressed twice. Decompress it by `zstd --decompress`.");
}

std::unique_ptr<Bag> open_file(const fs::path& file) {
  if (container_of(file) != BagContainer::kZstd) return open_inside(file);
  return std::make_unique<CompressedBag>(file, open_inside);
}

std::unique_ptr<Bag> open_in_folder(const fs::path& file) {
  if (container_of(file) != BagContainer::kRos1) return open_file(file);
  throw DataError(
      file.string() +
      ": is a bag of ROS 1, which metadata.yaml cannot describe. Name the file itself.");
}

std::unique_ptr<Bag> open_folder(const fs::path& folder) {
  if (is_bag(folder)) return open_ros2_folder(folder, open_in_folder);
  std::vector<std::string> inside;
  for (const fs::path& entry : entries_of(folder)) {
    if (has_bag_ending(entry) && inside.size() < 5) inside.push_back(entry.filename().string());
  }
  if (inside.empty()) {
    throw DataError(
        folder.string() +
        ": has no metadata.yaml and no .db3, .mcap or .bag file, so it is not a recording.");
  }
  throw UsageError(
      folder.string() +
      ": has no metadata.yaml, which lists the files of the recording, and its files do not share "
      "one name with the endings _0, _1 and so on. Name one of its files (" +
      join(inside) + "), or write it by `ros2 bag reindex " + folder.filename().string() + "`.");
}

}  // namespace

bool is_bag(const fs::path& path) {
  if (is_folder(path)) {
    return if_whole([&] {
             return has_file(path / "metadata.yaml") || !split_recording(path).empty();
           }) == true;
  }
  return has_bag_ending(path) && is_file(path);
}

std::unique_ptr<Bag> open_bag(const fs::path& path) {
  std::unique_ptr<Bag> bag = is_folder(path) ? open_folder(without_slash(path)) : open_file(path);
  const auto& topics = bag->topics();
  const bool has_any = std::any_of(topics.begin(), topics.end(),
                                   [](const BagTopic& topic) { return topic.messages > 0; });
  if (has_any) return bag;
  throw DataError(path.string() + ": holds no message that can be read. " +
                  join(bag->damage(), " ") + " Copy it again, or name another recording.");
}

}  // namespace raymoval
