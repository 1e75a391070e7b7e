// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "datasets/bags/bag.h"

namespace raymoval {

/// What a file is, by its first bytes.
enum class BagContainer { kRos1, kMcap, kDb3, kZstd };

/// @throws DataError if it begins as none of them; UsageError for a form that is known and not read
BagContainer container_of(const std::filesystem::path& file);

/// `open_bag` of a recording that may have no message.
std::unique_ptr<Bag> open_any_bag(const std::filesystem::path& path);

}  // namespace raymoval
