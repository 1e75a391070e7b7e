// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {

/// @param bytes the file, or at least its whole header
/// @throws DataError with file and line: missing or contradictory entries, unknown types, no x y z
CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path);

}  // namespace raymoval
