// SPDX-License-Identifier: MIT
#include "datasets/bags/ros2/metadata.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/bags/chunks/temporary_copy.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{16} << 20;
constexpr int kLastVersion = 9;
/// Up to this version files are listed with the name of their folder before them.
constexpr int kLastWithFolder = 3;

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter & 0x7F));
  return text;
}

std::string value_of(const YamlNode& node, std::string_view key) {
  const YamlNode* found = node.find(key);
  return found == nullptr ? "" : found->value;
}

std::optional<std::uint64_t> count_of(const YamlNode& node, const fs::path& path) {
  const YamlNode* found = node.find("message_count");
  if (found == nullptr) return std::nullopt;
  if (const auto count = parse_number<std::uint64_t>(found->value)) return count;
  throw DataError(path.string() + ":" + std::to_string(found->line) + ": message_count is '" +
                  found->value.substr(0, 40) + "', expected a number of messages.");
}

/// A path that leads nowhere but to a file in the folder.
bool stays_inside(const fs::path& listed) {
  return listed.is_relative() && !listed.empty() &&
         std::find(listed.begin(), listed.end(), "..") == listed.end();
}

/// Where a listed file may stand, the likeliest first. A folder that was renamed or moved has its
/// files still, whatever is listed.
std::vector<fs::path> candidates(const fs::path& folder, const fs::path& listed, int version) {
  std::vector<fs::path> places;
  if (stays_inside(listed)) {
    const bool has_folder = std::distance(listed.begin(), listed.end()) > 1;
    if (version <= kLastWithFolder && has_folder) {
      places.push_back(folder / listed.lexically_relative(*listed.begin()));
    }
    places.push_back(folder / listed);
  }
  places.push_back(folder / listed.filename());
  // A file may have been packed or unpacked by hand.
  for (const fs::path& place : std::vector<fs::path>(places)) {
    places.push_back(place.string() + ".zstd");
    places.push_back(without_zstd_ending(place));
  }
  return places;
}

void add_file(Ros2Metadata& metadata, const YamlNode& node, std::set<fs::path>& known) {
  const fs::path folder = metadata.path.parent_path();
  if (node.value.empty()) {
    throw DataError(metadata.path.string() + ":" + std::to_string(node.line) +
                    ": the name of a file is empty; `ros2 bag reindex` writes the file anew.");
  }
  Ros2File file;
  file.listed = node.value;
  const auto places = candidates(folder, file.listed, metadata.version);
  const auto found = std::find_if(places.begin(), places.end(), [](const fs::path& place) {
    return place.has_filename() && is_file(place);
  });
  file.is_there = found != places.end();
  file.path = file.is_there ? *found : places.front();
  if (known.insert(file.path).second) {
    metadata.files.push_back(std::move(file));
  } else {
    metadata.twice.push_back(file.listed);
  }
}

Ros2Packing packing_of(const YamlNode& information, const fs::path& path) {
  const std::string mode = lower(value_of(information, "compression_mode"));
  const std::string format = lower(value_of(information, "compression_format"));
  if (mode.empty() || mode == "none" || mode == "~" || mode == "null") return Ros2Packing::kNone;
  if (format != "zstd") {
    throw UsageError(path.string() + ": the recording is packed by '" + format +
                     "', which is not read; expected zstd. `ros2 bag convert` writes it anew.");
  }
  if (mode == "file") return Ros2Packing::kByFile;
  if (mode == "message") return Ros2Packing::kByMessage;
  throw UsageError(path.string() + ": compression_mode is '" + mode +
                   "', which is not read; expected FILE or MESSAGE. `ros2 bag convert` writes the "
                   "recording anew.");
}

/// Says of each listed file how many messages it should have.
void add_counts(Ros2Metadata& metadata) {
  const YamlNode* files = metadata.information.find("files");
  if (files == nullptr) return;
  std::map<std::string, std::optional<std::uint64_t>> counts;
  for (const YamlNode& node : files->children) {
    counts.emplace(value_of(node, "path"), count_of(node, metadata.path));
  }
  for (Ros2File& file : metadata.files) {
    const auto said = counts.find(file.listed);
    if (said != counts.end()) file.messages = said->second;
  }
}

void check_version(const Ros2Metadata& metadata) {
  const std::string where = metadata.path.string() + ": ";
  if (metadata.version < 1 || metadata.version > kLastVersion) {
    throw UsageError(where + "is of version '" + value_of(metadata.information, "version") +
                     "'; versions 1 to 9 are read. Name its .db3 or .mcap file instead.");
  }
  if (metadata.storage != "sqlite3" && metadata.storage != "mcap") {
    throw UsageError(where + "the recording is stored by '" + metadata.storage +
                     "', which is not read; expected sqlite3 or mcap. `ros2 bag convert` writes it "
                     "anew.");
  }
}

}  // namespace

Ros2Metadata read_ros2_metadata(const fs::path& folder) {
  Ros2Metadata metadata;
  metadata.path = folder / "metadata.yaml";
  if (plain_file_size(metadata.path) > kMostBytes) {
    throw DataError(metadata.path.string() +
                    ": has more than 16 MiB, so it does not describe a "
                    "recording.");
  }
  metadata.text = read_text(metadata.path);
  const YamlNode all = parse_block_yaml(metadata.text, metadata.path.string());
  const YamlNode* information = all.find("rosbag2_bagfile_information");
  if (information == nullptr) {
    throw DataError(metadata.path.string() +
                    ": has no 'rosbag2_bagfile_information', so it does not describe a recording "
                    "of ROS 2. Name the .db3 or .mcap file instead.");
  }
  metadata.information = *information;
  metadata.version = parse_number<int>(value_of(*information, "version")).value_or(0);
  metadata.storage = value_of(*information, "storage_identifier");
  check_version(metadata);
  metadata.packing = packing_of(*information, metadata.path);
  metadata.messages = count_of(*information, metadata.path);
  const YamlNode* files = information->find("relative_file_paths");
  if (files == nullptr || files->children.empty()) {
    throw DataError(metadata.path.string() +
                    ": lists no file below 'relative_file_paths'; `ros2 bag reindex` writes it "
                    "anew.");
  }
  std::set<fs::path> known;
  for (const YamlNode& file : files->children) add_file(metadata, file, known);
  add_counts(metadata);
  return metadata;
}

}  // namespace raymoval
