// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/chunks/unpack.h"
#include "datasets/bags/ros1/records.h"

namespace raymoval {

/// How the messages of a chunk are packed.
enum class Ros1Compression : std::uint8_t { kNone, kBz2, kLz4 };
/// "none", "bz2" or "lz4", as a chunk's header says it.
std::string_view ros1_compression_name(Ros1Compression compression);

/// A chunk of a ROS 1 bag: messages and connections, packed together.
struct Ros1Chunk {
  std::uint64_t begin = 0;       ///< Where its record stands in the file.
  std::uint64_t data_begin = 0;  ///< Where its packed bytes stand.
  std::uint32_t packed = 0;      ///< Packed bytes that are there.
  std::uint32_t size = 0;        ///< Bytes unpacked, as its header says.
  Ros1Compression compression = Ros1Compression::kNone;
  bool cut = false;  ///< Whether the file ends before the chunk does.
};

/// The chunk that `record` is. Of one that is cut, what is there.
/// @param begin where the record stands
/// @throws DataError naming what is wrong with its header, with a size beyond the limits of
///   `check_unpacked_size`, and for a compression that is unknown
Ros1Chunk read_chunk(const Ros1Bytes& file, const Ros1Record& record, std::uint64_t begin);

/// The unpacked bytes of a chunk as far as they can be had. @throws UnreadableError
Unpacked unpack_chunk(const BagFile& file, const Ros1Chunk& chunk);

/// The bytes of a chunk that is not packed, read from the file when asked for.
class Ros1PlainChunkBytes : public Ros1Bytes {
 public:
  Ros1PlainChunkBytes(const BagFile& file, const Ros1Chunk& chunk) : file_(file), chunk_(chunk) {}
  [[nodiscard]] std::uint64_t size() const override { return chunk_.packed; }
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const override {
    return file_.read(chunk_.data_begin + offset, count);
  }
  [[nodiscard]] std::string place(std::uint64_t offset) const override {
    return file_.place(chunk_.data_begin + offset);
  }

 private:
  const BagFile& file_;
  const Ros1Chunk& chunk_;
};

/// A message or a connection in a chunk.
struct Ros1ChunkRecord {
  Ros1Op op = Ros1Op::kMessage;
  std::uint64_t begin = 0;  ///< In the unpacked chunk.
  Ros1Record record;
  std::uint32_t connection = 0;  ///< Of a message.
  Nanoseconds time = 0;          ///< Of a message: when it was recorded.
};

/// Goes through the records of an unpacked chunk from front to back.
class Ros1ChunkWalk {
 public:
  /// @param bytes outlives this object
  explicit Ros1ChunkWalk(const Ros1Bytes& bytes) : bytes_(bytes) {}
  /// Goes on at `offset`.
  void jump(std::uint64_t offset) { at_ = offset; }
  /// The next message or connection that is there whole; others are skipped. Nothing at the end,
  /// and where the chunk is damaged. @throws UnreadableError
  std::optional<Ros1ChunkRecord> next();
  /// What is wrong where `next` ended, as a sentence; empty at the end of the chunk.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  std::optional<Ros1ChunkRecord> read_next();

  const Ros1Bytes& bytes_;
  std::uint64_t at_ = 0;
  std::string problem_;
};

}  // namespace raymoval
