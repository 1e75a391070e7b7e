// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace raymoval {

/// One Zstandard frame, which says how much it unpacks to.
std::string pack_zstd(std::string_view bytes);

/// One lz4 frame, which is also what ROS 1 calls lz4.
std::string pack_lz4(std::string_view bytes);

/// One bzip2 stream.
std::string pack_bz2(std::string_view bytes);

}  // namespace raymoval
