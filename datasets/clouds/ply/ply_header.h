// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {

/// The header of a PLY file. What stands before the vertices in a binary file is walked through, so
/// that `body_offset` is where they begin.
/// @param bytes the file
/// @throws DataError with file and line: missing or contradictory entries, unknown types, no x y z;
///   a vertex with a list; elements before the vertices that the file has no bytes for
CloudHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path);

}  // namespace raymoval
