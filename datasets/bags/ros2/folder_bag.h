// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/bag_index.h"

namespace raymoval {

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

/// @throws DataError naming the line that is wrong; UsageError for a storage or a compression that
///   is not supported; UnreadableError
Ros2Metadata read_ros2_metadata(const std::filesystem::path& folder);

/// The files of a folder without metadata.yaml that are parts of one recording: NAME_0.db3,
/// NAME_1.db3 and so on (or .mcap), in this order. None if there are others, scans or folders.
std::vector<std::filesystem::path> split_recording(const std::filesystem::path& folder);

/// A recording of ROS 2 in one file or several, in a folder with metadata.yaml, or without it as
/// `split_recording`. Its index takes 32 bytes per message.
class Ros2FolderBag : public Bag {
 public:
  /// Opens a file of the folder.
  using Open = std::function<std::unique_ptr<Bag>(const std::filesystem::path&)>;
  /// @throws DataError if metadata.yaml is damaged or none of its files is there; UsageError for a
  ///   format that is not supported; UnreadableError
  Ros2FolderBag(std::filesystem::path folder, const Open& open);

  [[nodiscard]] const std::filesystem::path& path() const override { return folder_; }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return table_.topics(); }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return table_.at(topic, index).recorded;
  }
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
  void add_part(std::size_t file, const Open& open);
  void check_counts();

  std::filesystem::path folder_;
  Ros2Metadata metadata_;
  DamageNotes damage_;
  std::vector<Part> parts_;
  MessageTable table_;
};

}  // namespace raymoval
