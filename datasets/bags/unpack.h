// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "datasets/bags/bag_file.h"

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

/// Keeps the chunks of a recording that were unpacked last, so that the messages of a chunk do not
/// each unpack it. All calls are thread-safe; a chunk that several threads ask for is unpacked by
/// the first of them, and the others wait.
class ChunkStore {
 public:
  using Chunk = std::shared_ptr<const std::string>;
  using Unpack = std::function<std::string()>;

  /// @param most_bytes what is kept at most, except that the chunk asked for last is always kept
  explicit ChunkStore(std::size_t most_bytes = std::size_t{16} << 20U) : most_bytes_(most_bytes) {}

  /// The chunk `number`, which `unpack` makes unless it is kept. What `unpack` throws goes through,
  /// and the next call tries again.
  Chunk get(std::uint64_t number, const Unpack& unpack);

 private:
  struct Slot {
    std::mutex unpacking;
    Chunk chunk;  ///< Null until it is unpacked.
  };
  struct Kept {
    std::uint64_t number;
    std::shared_ptr<Slot> slot;
    std::size_t bytes;
  };

  std::shared_ptr<Slot> slot_of(std::uint64_t number);
  void note_size(std::uint64_t number, std::size_t bytes);

  std::size_t most_bytes_;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< The one asked for last comes first.
};

/// "drive_0.db3" of "drive_0.db3.zstd" and of "drive_0.db3.zst"; other names as they are.
std::filesystem::path without_zstd_ending(const std::filesystem::path& name);

}  // namespace raymoval
