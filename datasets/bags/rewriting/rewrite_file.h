// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/file_writer.h"
#include "datasets/bags/bag.h"
#include "datasets/bags/mcap/mcap_bag.h"
#include "datasets/bags/rewriting/rewrite_bag.h"
#include "datasets/bags/ros1/ros1_bag.h"
#include "datasets/bags/ros2/db3_bag.h"

namespace raymoval {

/// Writes the messages of `bag` to a file of its kind. @throws whatever `change` throws; DataError
///   if it cannot be written; UnreadableError
void rewrite_mcap(const McapBag& bag, FileWriter& output, const ChangeMessage& change);
void rewrite_ros1(const Ros1Bag& bag, FileWriter& output, const ChangeMessage& change);
/// @param output an empty file
void rewrite_db3(const Db3Bag& bag, const std::filesystem::path& output,
                 const ChangeMessage& change);

/// A packed or plain file of any kind, which gets its name by `together`.
void rewrite_file(const Bag& bag, const std::filesystem::path& output, const ChangeMessage& change,
                  Replacements& together);

}  // namespace raymoval
