// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace raymoval {

/// @throws DataError if `packed` deflated bytes cannot decompress to `unpacked` bytes within the
///   limit: 1 GiB, and 1,000 times the compressed bytes plus 1 MiB
/// @param where begins the message, such as the file's path
void check_decompressed(std::uint64_t packed, std::uint64_t unpacked, const std::string& where);

/// Decompresses a gzip file of one or more members; zeros may follow the last member.
/// @throws DataError if it is damaged (checksums are compared), is truncated, has other bytes
///   behind its end, or as `check_decompressed`
std::string decompress_gzip(std::string_view packed, const std::string& where);

}  // namespace raymoval
