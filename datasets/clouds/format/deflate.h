// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace raymoval {

/// Unpacks a gzip file of one or more members; zeros may follow the last one. What it unpacks to is
/// limited to 1 GiB, and to 1,000 times what it is packed in and a MiB.
/// @param where begins the message, such as the file's path
/// @throws DataError if it is damaged (checksums are compared), ends too soon, has other bytes
///   behind its end, or unpacks to more than the limit
std::string unpack_gzip(std::string_view packed, const std::string& where);

/// Unpacks a deflated member of a zip archive.
/// @param size what it has to unpack to; the same limit holds for it
/// @throws DataError as `unpack_gzip`, and if it unpacks to another size
std::string inflate_member(std::string_view packed, std::uint64_t size, const std::string& where);

/// Packs bytes as one member of a gzip file, without a time or a name.
std::string pack_gzip(std::string_view bytes);

/// Packs bytes as a deflated member of a zip archive.
std::string deflate_member(std::string_view bytes);

/// The checksum of zip and gzip.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace raymoval
