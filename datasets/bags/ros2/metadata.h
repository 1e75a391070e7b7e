// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/bags/ros2/block_yaml.h"

namespace raymoval {

/// How a recording of ROS 2 is packed.
enum class Ros2Packing { kNone, kByFile, kByMessage };

/// A file of a recording as metadata.yaml lists it.
struct Ros2File {
  std::string listed;          ///< As it is written there.
  std::filesystem::path path;  ///< Where it is, in the recording's folder.
  bool is_there = false;
  std::optional<std::uint64_t> messages;  ///< That it should have, if that is said.
};

/// What metadata.yaml says of a folder, versions 1 to 9.
struct Ros2Metadata {
  std::filesystem::path path;
  std::string text;
  int version = 0;
  std::string storage;  ///< "sqlite3", "mcap".
  Ros2Packing packing = Ros2Packing::kNone;
  std::optional<std::uint64_t> messages;
  std::vector<Ros2File> files;     ///< In order, each once.
  std::vector<std::string> twice;  ///< Those that are listed more than once.
  YamlNode information;            ///< All of it.
};

/// @throws DataError naming the line that is wrong; UsageError for a storage or a packing that is
///   not read; UnreadableError
Ros2Metadata read_ros2_metadata(const std::filesystem::path& folder);

}  // namespace raymoval
