// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/stored_points.h"

namespace raymoval {

/// The points of a binary PCD or PLY file.
/// @param body the bytes from the first point on
/// @throws DataError if there are fewer bytes than the header's points take
StoredPoints binary_points(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path);

}  // namespace raymoval
