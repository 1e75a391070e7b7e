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

/// Limit of the size to which `packed` bytes decompress: 1 GiB, and 1,000 times `packed` plus
/// 1 MiB.
std::uint64_t most_decompressed_size(std::uint64_t packed);

/// Refuses a stated decompressed size beyond `most_decompressed_size`, before memory is allocated.
/// It is also for other compressions.
/// @param where begins the message, such as "drive.bag: byte 4,117: chunk"
/// @throws DataError
void check_decompressed_size(std::uint64_t packed, std::uint64_t unpacked,
                             const std::string& where);

/// Decompressed bytes, and the problem if they are incomplete.
struct Decompressed {
  std::string bytes;
  std::string problem;  ///< "the lz4 frame ends early", for messages; empty if complete.
};

/// Decompresses bzip2 data (one stream or several).
/// @param stated decompressed size as stated by the file, bytes; the result is never larger
/// @throws DataError as `check_decompressed_size`. Damage is no error: the result has the bytes
/// before
///   it, and the problem
Decompressed decompress_bz2(std::string_view packed, std::uint64_t stated,
                            const std::string& where);

/// Decompresses lz4 frames (one or several), as also used by ROS 1. As `decompress_bz2`.
Decompressed decompress_lz4(std::string_view packed, std::uint64_t stated,
                            const std::string& where);

/// Whether `bytes` begin like Zstandard data.
bool is_zstd(std::string_view bytes);

/// Decompresses Zstandard frames (one or several). As `decompress_bz2`.
Decompressed decompress_zstd(std::string_view packed, std::uint64_t stated,
                             const std::string& where);

/// Decompresses Zstandard data without a stated size. The size is taken from its frame; if the
/// frame has none, the limit of `check_decompressed_size` holds.
/// @throws DataError if it is damaged
std::string decompress_zstd_message(std::string_view packed, const std::string& where);

/// Decompresses `message` if rosbag2 compressed it by itself. CDR never begins like Zstandard.
/// @throws DataError as `decompress_zstd_message`
std::string decompressed_if_needed(std::string message, bool is_cdr, const std::string& where);

/// Decompresses a file piece by piece.
/// @param most limit of the decompressed size, bytes
/// @return the problem, such as a truncated end; empty if the file is complete
/// @throws DataError if it decompresses to more than `most`, or more than 1,000 times its bytes and
///   1 MiB; UnreadableError if the disk fails; the errors of `take`
std::string decompress_zstd_file(const BagFile& file, std::uint64_t most,
                                 const std::function<void(std::string_view)>& take);

/// A cache of the chunks of a recording that were decompressed last, so that a chunk is not
/// decompressed once per message. All calls are thread-safe; if several threads request a chunk,
/// the first decompresses it and the others wait.
class ChunkStore {
 public:
  using Chunk = std::shared_ptr<const std::string>;
  using Unpack = std::function<std::string()>;

  /// @param most_bytes limit of the cache; the chunk requested last is always kept
  explicit ChunkStore(std::size_t most_bytes = std::size_t{16} << 20U) : most_bytes_(most_bytes) {}

  /// The chunk `number`; calls `unpack` if the cache does not have it. After an error of `unpack`,
  /// which is passed on, the next call tries again.
  Chunk get(std::uint64_t number, const Unpack& unpack);

 private:
  struct Slot {
    std::mutex unpacking;
    Chunk chunk;  ///< Null until it is decompressed.
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
  std::list<Kept> kept_;  ///< The chunk requested last comes first.
};

/// "drive_0.db3" of "drive_0.db3.zstd" and of "drive_0.db3.zst"; other names are unchanged.
std::filesystem::path without_zstd_ending(const std::filesystem::path& name);

}  // namespace raymoval
