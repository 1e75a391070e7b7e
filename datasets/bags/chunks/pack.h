// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/file_writer.h"

namespace raymoval {

/// One Zstandard frame, which says how much it unpacks to.
std::string pack_zstd(std::string_view bytes);

/// Packs a file piece by piece. @throws DataError if one cannot be read or the other not written
void pack_zstd_file(const std::filesystem::path& file, FileWriter& output);

/// One lz4 frame of the kind that ROS 1 reads, too: independent blocks, and a checksum.
std::string pack_lz4(std::string_view bytes);

/// One bzip2 stream.
std::string pack_bz2(std::string_view bytes);

}  // namespace raymoval
