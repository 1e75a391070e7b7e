// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace raymoval {

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

}  // namespace raymoval
