// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "datasets/bags/bag.h"

/// The formats of recordings. `open_bag` chooses among them by the first bytes of a file. All throw
/// UnreadableError if the disk fails.
namespace raymoval {

/// A MCAP file. @throws DataError if it is none
std::unique_ptr<Bag> open_mcap(const std::filesystem::path& path);

/// A ROS 1 bag of version 2.0, not compressed or compressed by bz2 or lz4.
/// @throws DataError if it is none, or encrypted
std::unique_ptr<Bag> open_ros1(const std::filesystem::path& path);

/// A SQLite database of rosbag2 (.db3).
/// @throws DataError if it is no database, lacks the tables of rosbag2, or has a journal or a
///   write-ahead log of unfinished writes beside it
std::unique_ptr<Bag> open_db3(const std::filesystem::path& path);

using OpenBag = std::function<std::unique_ptr<Bag>(const std::filesystem::path&)>;

/// A recording of ROS 2 in a folder with metadata.yaml (versions 1 to 9), or without it as
/// `split_recording`.
/// @param open opens a file of the folder
/// @throws DataError if metadata.yaml is damaged or none of its files is there; UsageError for a
///   storage or a compression that is not supported
std::unique_ptr<Bag> open_ros2_folder(const std::filesystem::path& folder, const OpenBag& open);

/// The files of a folder without metadata.yaml that are parts of one recording: NAME_0.db3,
/// NAME_1.db3 and so on (or .mcap), in this order. None if there are others, scans or folders.
std::vector<std::filesystem::path> split_recording(const std::filesystem::path& folder);

}  // namespace raymoval
