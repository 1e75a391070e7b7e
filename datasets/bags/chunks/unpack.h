// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace raymoval {

/// What `packed` bytes may unpack to at most: 1 GiB, and 1,000 times the packed bytes and 1 MiB.
std::uint64_t most_unpacked_size(std::uint64_t packed);

/// Refuses a size that packed bytes are said to have unpacked, before memory is asked for, if it is
/// more than `most_unpacked_size`. It is also for other compressions.
/// @param where begins the message, such as "drive.bag: byte 4,117: chunk"
/// @throws DataError
void check_unpacked_size(std::uint64_t packed, std::uint64_t unpacked, const std::string& where);

/// What was unpacked, and why it ends before its end.
struct Unpacked {
  std::string bytes;
  std::string problem;  ///< "the lz4 frame ends early", for messages; empty if all of it is there.
};

/// Unpacks bzip2 data (one stream or several).
/// @param stated bytes that it has unpacked, by what stands beside it; never more than these are
///   made
/// @throws DataError as `check_unpacked_size`, and nothing else: damage is told in the answer, with
///   what stands before it
Unpacked unpack_bz2(std::string_view packed, std::uint64_t stated, const std::string& where);

/// Unpacks lz4 frames (one or several), which is also what ROS 1 calls lz4. As `unpack_bz2`.
Unpacked unpack_lz4(std::string_view packed, std::uint64_t stated, const std::string& where);

}  // namespace raymoval
