// SPDX-License-Identifier: MIT
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/decompress.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/frames.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// A file of a recording as metadata.yaml lists it.
struct Ros2File {
  std::string listed;          ///< As written there.
  std::filesystem::path path;  ///< Where it is, in the recording's folder.
  bool is_there = false;
  std::optional<std::uint64_t> messages;  ///< The stated number, if there is one.
};

/// The content of metadata.yaml, versions 1 to 9.
struct Ros2Metadata {
  std::filesystem::path path;
  int version = 0;
  std::optional<std::uint64_t> messages;
  std::vector<Ros2File> files;     ///< In order, each once.
  std::vector<std::string> twice;  ///< Files that are listed more than once.
};

constexpr std::uintmax_t kMostBytes = std::uintmax_t{16} << 20;
constexpr int kLastVersion = 9;
/// Up to this version files are listed with the name of their folder before them.
constexpr int kLastWithFolder = 3;

/// The value of a key as text; empty if it is missing, a list or a map.
std::string value_of(const YAML::Node& node, const char* key) {
  const YAML::Node found = node[key];
  return found && found.IsScalar() ? found.Scalar() : "";
}

/// "metadata.yaml:17", to begin messages.
std::string place(const fs::path& path, const YAML::Mark& mark) {
  return path.string() + ":" + std::to_string(mark.line + 1);
}

std::optional<std::uint64_t> count_of(const YAML::Node& node, const fs::path& path) {
  const YAML::Node found = node["message_count"];
  if (!found) return std::nullopt;
  const std::string value = value_of(node, "message_count");
  if (const auto count = parse_number<std::uint64_t>(value)) return count;
  throw DataError(place(path, found.Mark()) + ": message_count is '" + value.substr(0, 40) +
                  "', expected a number of messages.");
}

/// Whether a path leads to a file in the folder.
bool stays_inside(const fs::path& listed) {
  return listed.is_relative() && !listed.empty() &&
         std::find(listed.begin(), listed.end(), "..") == listed.end();
}

/// Possible paths of a listed file, the likeliest first. A folder may have been renamed or moved
/// since metadata.yaml was written.
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
  // A file may have been compressed or decompressed by hand.
  for (const fs::path& place : std::vector<fs::path>(places)) {
    places.push_back(place.string() + ".zstd");
    places.push_back(without_zstd_ending(place));
  }
  return places;
}

void add_file(Ros2Metadata& metadata, const YAML::Node& node, std::set<fs::path>& known) {
  const fs::path folder = metadata.path.parent_path();
  Ros2File file;
  if (node.IsScalar()) file.listed = node.Scalar();
  if (file.listed.empty()) {
    throw DataError(place(metadata.path, node.Mark()) +
                    ": the name of a file is expected; `ros2 bag reindex` rewrites the file.");
  }
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

/// @throws UsageError for a compression that is not supported
void check_compression(const YAML::Node& information, const fs::path& path) {
  const std::string mode = in_lower_case(value_of(information, "compression_mode"));
  const std::string format = in_lower_case(value_of(information, "compression_format"));
  if (mode.empty() || mode == "none" || mode == "~" || mode == "null") return;
  if (format != "zstd") {
    throw UsageError(path.string() + ": the recording is compressed by '" + format +
                     "', which is not read; expected zstd. `ros2 bag convert` rewrites it.");
  }
  if (mode == "file" || mode == "message") return;
  throw UsageError(
      path.string() + ": compression_mode is '" + mode +
      "', which is not read; expected FILE or MESSAGE. `ros2 bag convert` rewrites the recording.");
}

/// Sets the stated number of messages of each listed file.
void add_counts(Ros2Metadata& metadata, const YAML::Node& information) {
  std::map<std::string, std::optional<std::uint64_t>> counts;
  for (const YAML::Node& node : information["files"]) {
    if (node.IsMap()) counts.emplace(value_of(node, "path"), count_of(node, metadata.path));
  }
  for (Ros2File& file : metadata.files) {
    const auto said = counts.find(file.listed);
    if (said != counts.end()) file.messages = said->second;
  }
}

void check_version(const YAML::Node& information, int version, const fs::path& path) {
  const std::string where = path.string() + ": ";
  if (version < 1 || version > kLastVersion) {
    throw UsageError(where + "is of version '" + value_of(information, "version") +
                     "'; versions 1 to 9 are read. Name its .db3 or .mcap file instead.");
  }
  const std::string storage = value_of(information, "storage_identifier");
  if (storage != "sqlite3" && storage != "mcap") {
    throw UsageError(
        where + "the recording is stored by '" + storage +
        "', which is not read; expected sqlite3 or mcap. `ros2 bag convert` rewrites it.");
  }
}

Ros2Metadata parsed_metadata(const fs::path& path) {
  Ros2Metadata metadata;
  metadata.path = path;
  const YAML::Node all = YAML::Load(read_text(path));
  const YAML::Node information =
      all.IsMap() ? all["rosbag2_bagfile_information"] : YAML::Node(YAML::NodeType::Null);
  if (!information || !information.IsMap()) {
    throw DataError(path.string() +
                    ": has no 'rosbag2_bagfile_information', so it does not describe a recording "
                    "of ROS 2. Name the .db3 or .mcap file instead.");
  }
  metadata.version = parse_number<int>(value_of(information, "version")).value_or(0);
  check_version(information, metadata.version, path);
  check_compression(information, path);
  metadata.messages = count_of(information, path);
  std::set<fs::path> known;
  for (const YAML::Node& file : information["relative_file_paths"]) {
    add_file(metadata, file, known);
  }
  if (metadata.files.empty()) {
    throw DataError(path.string() +
                    ": lists no file below 'relative_file_paths'; `ros2 bag reindex` rewrites it.");
  }
  add_counts(metadata, information);
  return metadata;
}

/// @throws DataError naming the line that is wrong; UsageError for a storage or a compression that
///   is not supported; UnreadableError
Ros2Metadata read_ros2_metadata(const fs::path& folder) {
  const fs::path path = folder / "metadata.yaml";
  if (plain_file_size(path) > kMostBytes) {
    throw DataError(path.string() + ": has more than 16 MiB, so it does not describe a recording.");
  }
  try {
    return parsed_metadata(path);
  } catch (const YAML::Exception& error) {
    throw DataError(place(path, error.mark) + ": " + error.msg +
                    ". Expected what `ros2 bag record` writes; `ros2 bag reindex` rewrites it.");
  }
}

/// A message's place is the number of its part and its number in its topic there.
constexpr unsigned kIndexBits = 44;
constexpr std::size_t kMostParts = std::size_t{1} << (63 - kIndexBits);

std::uint64_t place_of(std::size_t part, std::size_t index) {
  return std::uint64_t{part} << kIndexBits | index;
}

Ros2Metadata metadata_of(const fs::path& folder) {
  if (has_file(folder / "metadata.yaml")) return read_ros2_metadata(folder);
  Ros2Metadata metadata;
  metadata.path = folder;
  for (const fs::path& part : split_recording(folder)) {
    metadata.files.push_back({part.filename().string(), part, true, std::nullopt});
  }
  return metadata;
}

/// A recording of ROS 2 in one file or several, in a folder with metadata.yaml, or without it as
/// `split_recording`. Its index takes 32 bytes per message.
class Ros2FolderBag : public IndexedBag {
 public:
  /// @throws DataError if metadata.yaml is damaged or none of its files is there; UsageError for a
  ///   format that is not supported; UnreadableError
  Ros2FolderBag(std::filesystem::path folder, const OpenBag& open);

  [[nodiscard]] const std::filesystem::path& path() const override { return folder_; }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override;

 private:
  /// A file of the recording that could be opened.
  struct Part {
    std::size_t file = 0;  ///< In `metadata().files`.
    std::unique_ptr<Bag> bag;
    std::vector<std::size_t> topics;  ///< Number in `topics()` of each topic of the part.
  };
  /// A message in the file that holds it.
  struct Found {
    const Bag& bag;
    std::size_t topic, index;
  };
  [[nodiscard]] Found find(std::size_t topic, std::size_t index) const;
  void add_part(std::size_t file, const OpenBag& open);
  void check_counts();

  std::filesystem::path folder_;
  Ros2Metadata metadata_;
  std::vector<Part> parts_;
};

Ros2FolderBag::Ros2FolderBag(std::filesystem::path folder, const OpenBag& open)
    : folder_(std::move(folder)), metadata_(metadata_of(folder_)) {
  for (const std::string& listed : metadata_.twice) {
    damage_.add(metadata_.path.string() + ": lists " + listed + " twice; it is read once.");
  }
  if (metadata_.files.size() > kMostParts) {
    throw DataError(metadata_.path.string() + ": lists more files than a recording can have.");
  }
  for (std::size_t file = 0; file < metadata_.files.size(); ++file) add_part(file, open);
  if (parts_.empty()) {
    throw DataError(metadata_.path.string() + ": none of the files that it lists can be read. " +
                    join(damage_.sentences(), " "));
  }
  table_.finish();
  check_counts();
}

void Ros2FolderBag::add_part(std::size_t file, const OpenBag& open) {
  const Ros2File& listed = metadata_.files[file];
  if (!listed.is_there) {
    damage_.add(metadata_.path.string() + ": lists " + listed.listed +
                ", which is not there; its messages are missing. Copy it to the folder.");
    return;
  }
  Part part{file, nullptr, {}};
  const std::string damage = damage_in([&] { part.bag = open(listed.path); });
  if (!damage.empty()) {
    damage_.add(damage);
    return;
  }
  for (std::size_t own = 0; own < part.bag->topics().size(); ++own) {
    const BagTopic& topic = part.bag->topics()[own];
    part.topics.push_back(table_.topic(topic.name, topic.type, topic.encoding));
  }
  for (std::size_t own = 0; own < part.bag->topics().size(); ++own) {
    const std::uint64_t count = part.bag->topics()[own].messages;
    for (std::size_t i = 0; i < count; ++i) {
      table_.add(part.topics[own], {part.bag->recorded(own, i), place_of(parts_.size(), i)});
    }
  }
  parts_.push_back(std::move(part));
}

void Ros2FolderBag::check_counts() {
  const auto note = [&](const std::string& what, std::uint64_t said, std::uint64_t found) {
    damage_.add(metadata_.path.string() + ": says that " + what + " has " +
                counted_text(said, "message") + ", but " + grouped_text(found) + " can be read.");
  };
  for (const Part& part : parts_) {
    const Ros2File& file = metadata_.files[part.file];
    std::uint64_t found = 0;
    for (const BagTopic& topic : part.bag->topics()) found += topic.messages;
    if (file.messages && *file.messages != found) note(file.listed, *file.messages, found);
  }
  if (metadata_.messages && *metadata_.messages != table_.size()) {
    note("the recording", *metadata_.messages, table_.size());
  }
}

Ros2FolderBag::Found Ros2FolderBag::find(std::size_t topic, std::size_t index) const {
  const std::uint64_t place = table_.at(topic, index).place;
  const Part& part = parts_.at(place >> kIndexBits);
  const std::size_t own_index = place & ((std::uint64_t{1} << kIndexBits) - 1);
  const Nanoseconds stamp = table_.at(topic, index).recorded;
  // Two topics of a part are never one here: their names, types or encodings differ.
  for (std::size_t own = 0; own < part.topics.size(); ++own) {
    if (part.topics[own] != topic) continue;
    if (part.bag->recorded(own, own_index) == stamp) return {*part.bag, own, own_index};
  }
  throw InternalError("a message of a recording in a folder is in none of its files");
}

std::string Ros2FolderBag::message(std::size_t topic, std::size_t index) const {
  const Found found = find(topic, index);
  return found.bag.message(found.topic, found.index);
}

std::string Ros2FolderBag::message_head(std::size_t topic, std::size_t index,
                                        std::size_t most) const {
  const Found found = find(topic, index);
  return found.bag.message_head(found.topic, found.index, most);
}

std::vector<std::string> Ros2FolderBag::damage() const {
  DamageNotes all;
  for (const std::string& sentence : damage_.sentences()) all.add(sentence);
  for (const Part& part : parts_) {
    for (const std::string& sentence : part.bag->damage()) all.add(sentence);
  }
  return all.sentences();
}

}  // namespace

std::vector<fs::path> split_recording(const fs::path& folder) {
  std::vector<fs::path> parts;
  std::set<std::string> names;
  if (!folders_in(folder).empty()) return {};
  for (const fs::path& file : list_files(folder, {""})) {
    const fs::path name = without_zstd_ending(file.filename());
    const std::string ending = name.extension().string();
    if (ending == ".bag" || !cloud_extension(file).empty()) return {};
    if (ending != ".db3" && ending != ".mcap") continue;
    std::string stem = name.stem().string();
    const std::size_t number = stem.find_last_not_of("0123456789");
    if (number != std::string::npos && stem[number] == '_') stem.resize(number);
    names.insert(stem + ending);
    parts.push_back(file);
  }
  return names.size() == 1 ? parts : std::vector<fs::path>();
}

std::unique_ptr<Bag> open_ros2_folder(const fs::path& folder, const OpenBag& open) {
  return std::make_unique<Ros2FolderBag>(folder, open);
}

}  // namespace raymoval
