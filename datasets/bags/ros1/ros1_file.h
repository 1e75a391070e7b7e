// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/bag_file.h"
#include "datasets/bags/decompress.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The line that a ROS 1 bag begins with.
inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// The type of a record, in its field "op".
enum class Ros1Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// A record of a ROS 1 bag: its header with fields NAME=BYTES, and the place of its data.
struct Ros1Record {
  std::uint64_t begin = 0;
  std::string where;   ///< "drive.bag: byte 4,117", to begin messages.
  std::string header;  ///< The fields with their lengths.
  std::uint64_t data_begin = 0;
  std::uint32_t data_size = 0;

  [[nodiscard]] std::uint64_t end() const { return data_begin + data_size; }
  /// The type of the record, which may be unknown.
  /// @throws DataError if the field is missing or of another size; so do all readers below
  [[nodiscard]] Ros1Op op() const;
  [[nodiscard]] std::uint32_t u32(std::string_view field) const;
  [[nodiscard]] std::uint64_t u64(std::string_view field) const;
  /// Seconds and nanoseconds since 1970.
  [[nodiscard]] Nanoseconds time(std::string_view field) const;
  [[nodiscard]] std::string text(std::string_view field) const;
  /// An optional text field.
  [[nodiscard]] std::optional<std::string> find(std::string_view field) const;
};

/// The bytes of records: of a file, of a part of a file, or of a decompressed chunk.
class Ros1Bytes {
 public:
  explicit Ros1Bytes(const BagFile& file) : Ros1Bytes(file, 0, file.size()) {}
  /// The records of a chunk that is not compressed; `read` reads them from the file.
  Ros1Bytes(const BagFile& file, std::uint64_t begin, std::uint64_t size)
      : file_(&file), begin_(begin), size_(size) {}
  /// The records of a decompressed chunk. @param chunk_place place of the chunk, for messages
  Ros1Bytes(std::string_view unpacked, std::string chunk_place)
      : size_(unpacked.size()), unpacked_(unpacked), chunk_place_(std::move(chunk_place)) {}

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// @param count at most the bytes from `offset` to the end
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;
  /// "drive.bag: byte 4,117", to begin messages.
  [[nodiscard]] std::string place(std::uint64_t offset) const;

 private:
  const BagFile* file_ = nullptr;
  std::uint64_t begin_ = 0, size_ = 0;
  std::string_view unpacked_;
  std::string chunk_place_;
};

/// The record at `offset`; its data may be truncated.
/// @throws DataError naming the byte if the header is truncated, or its lengths do not fit
Ros1Record read_record(const Ros1Bytes& bytes, std::uint64_t offset);

/// @throws DataError naming the byte if the data of a record is truncated
void check_data_is_there(const Ros1Bytes& bytes, const Ros1Record& record);

/// The next message or connection of a decompressed chunk from `at` on, which must be whole. Other
/// records are skipped, and `at` is moved behind it. Empty at the end.
/// @throws DataError naming the byte where the chunk is damaged
std::optional<Ros1Record> next_in_chunk(const Ros1Bytes& bytes, std::uint64_t& at);

/// A number of `Number`'s size. @param offset with at least that many bytes behind it
template <class Number>
Number little_endian(std::string_view bytes, std::size_t offset) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    number |= static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(bytes[offset + i]))
                                  << (8 * i));
  }
  return number;
}

/// The time that ROS 1 writes as two numbers of 32 bits: seconds, nanoseconds.
Nanoseconds ros1_time(std::string_view bytes, std::size_t offset);

/// A connection: a publisher of a topic.
struct Ros1Connection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type, md5;
};

/// @throws DataError naming what its record lacks
Ros1Connection read_connection(const Ros1Bytes& bytes, const Ros1Record& record);

/// The compression of a chunk.
enum class Ros1Compression : std::uint8_t { kNone, kBz2, kLz4 };

/// A chunk of a ROS 1 bag: messages and connections, compressed together.
struct Ros1Chunk {
  std::uint64_t begin = 0;       ///< Place of its record in the file.
  std::uint64_t data_begin = 0;  ///< Place of its compressed bytes in the file.
  std::uint32_t packed = 0;      ///< Compressed bytes in the file.
  std::uint32_t size = 0;        ///< Decompressed bytes, as stated in its header.
  Ros1Compression compression = Ros1Compression::kNone;
  bool cut = false;  ///< Whether the file ends before the chunk does.
};

/// The chunk of `record`, which may be truncated.
/// @throws DataError for a damaged header, a size beyond the limit of `check_decompressed_size`,
/// and an
///   unknown compression
Ros1Chunk read_chunk(const Ros1Bytes& file, const Ros1Record& record);

/// Decompresses a chunk as far as possible. @throws UnreadableError
Decompressed decompress_chunk(const BagFile& file, const Ros1Chunk& chunk);

}  // namespace raymoval
