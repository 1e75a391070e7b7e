// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace raymoval {

/// Undoes the LZF compression of the body of a binary_compressed PCD file after checking the sizes
/// that it announces.
/// @throws DataError if they do not fit the bytes there are or `expected_bytes`, or cannot be LZF's
std::string unpack_lzf_block(std::string_view body, std::uint64_t expected_bytes,
                             const std::filesystem::path& path);

/// The body of a binary_compressed PCD file that unpacks to `data`.
/// @throws DataError beyond 4 GiB
std::string pack_lzf_block(std::string_view data);

}  // namespace raymoval
