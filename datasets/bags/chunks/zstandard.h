// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "datasets/bags/chunks/bag_file.h"
#include "datasets/bags/chunks/unpack.h"

namespace raymoval {

/// Whether `bytes` begin as Zstandard data does.
bool is_zstd(std::string_view bytes);

/// Unpacks Zstandard frames (one or several). As `unpack_bz2`.
Unpacked unpack_zstd(std::string_view packed, std::uint64_t stated, const std::string& where);

/// The same of data beside which nothing says how much it unpacks to: what its frame says, and if
/// that does not say it either, up to the limit of `check_unpacked_size`.
/// @throws DataError if it is damaged
std::string unpack_zstd_message(std::string_view packed, const std::string& where);

/// A message as it was published, of one that rosbag2 may have packed alone. What is CDR never
/// begins as Zstandard does.
/// @throws DataError as `unpack_zstd_message`
std::string unpacked_if_packed(std::string message, bool is_cdr, const std::string& where);

/// Unpacks a file piece by piece.
/// @param most bytes that it may unpack to
/// @return what is wrong with it, such as a cut end; empty if all of it was unpacked
/// @throws DataError if it unpacks to more than `most`, or more than 1,000 times its bytes and
///   1 MiB; UnreadableError if the disk fails; whatever `take` throws
std::string unpack_zstd_file(const BagFile& file, std::uint64_t most,
                             const std::function<void(std::string_view)>& take);

}  // namespace raymoval
