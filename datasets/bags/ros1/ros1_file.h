// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/bag_file.h"
#include "datasets/bags/unpack.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The line that a ROS 1 bag begins with.
inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// What a record is, as its field "op" says.
enum class Ros1Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// A record of a ROS 1 bag: its header, whose fields are NAME=BYTES, and where its data stands.
struct Ros1Record {
  std::uint64_t begin = 0;
  std::string where;   ///< "drive.bag: byte 4,117", to begin messages.
  std::string header;  ///< The fields with their lengths.
  std::uint64_t data_begin = 0;
  std::uint32_t data_size = 0;

  [[nodiscard]] std::uint64_t end() const { return data_begin + data_size; }
  /// What the record is, which may be an op that is unknown.
  /// @throws DataError if the field is missing or of another size; so do all others
  [[nodiscard]] Ros1Op op() const;
  [[nodiscard]] std::uint32_t u32(std::string_view field) const;
  [[nodiscard]] std::uint64_t u64(std::string_view field) const;
  /// Seconds and nanoseconds since 1970.
  [[nodiscard]] Nanoseconds time(std::string_view field) const;
  [[nodiscard]] std::string text(std::string_view field) const;
  /// The same of a field that may be missing.
  [[nodiscard]] std::optional<std::string> find(std::string_view field) const;
};

/// Bytes that records stand in, of which those from a place on can be asked for.
class Ros1Bytes {
 public:
  explicit Ros1Bytes(const BagFile& file) : Ros1Bytes(file, 0, file.size()) {}
  /// The records of a chunk that is not packed, read from the file when asked for.
  Ros1Bytes(const BagFile& file, std::uint64_t begin, std::uint64_t size)
      : file_(&file), begin_(begin), size_(size) {}
  /// The records of a chunk, unpacked. @param chunk_place where the chunk stands, for messages
  Ros1Bytes(std::string_view unpacked, std::string chunk_place)
      : size_(unpacked.size()), unpacked_(unpacked), chunk_place_(std::move(chunk_place)) {}

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// @param count at most what is there from `offset` on
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;
  /// "drive.bag: byte 4,117", to begin messages.
  [[nodiscard]] std::string place(std::uint64_t offset) const;

 private:
  const BagFile* file_ = nullptr;
  std::uint64_t begin_ = 0, size_ = 0;
  std::string_view unpacked_;
  std::string chunk_place_;
};

/// The record at `offset`; its data need not be there whole.
/// @throws DataError naming the byte if the record's header is cut, or its lengths do not fit
Ros1Record read_record(const Ros1Bytes& bytes, std::uint64_t offset);

/// What a record must have whole, besides its header. @throws DataError naming the byte if not
void check_data_is_there(const Ros1Bytes& bytes, const Ros1Record& record);

/// The next message or connection of an unpacked chunk from `at` on, which must be there whole;
/// others are skipped, and `at` is moved behind it. Nothing at the end.
/// @throws DataError naming the byte where the chunk is damaged
std::optional<Ros1Record> next_in_chunk(const Ros1Bytes& bytes, std::uint64_t& at);

/// A number of `Number`'s size at `offset`, which has to be there.
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
/// @throws DataError naming what is wrong with its header, with a size beyond the limits of
///   `check_unpacked_size`, and for a compression that is unknown
Ros1Chunk read_chunk(const Ros1Bytes& file, const Ros1Record& record);

/// The unpacked bytes of a packed chunk as far as they can be had. @throws UnreadableError
Unpacked unpack_chunk(const BagFile& file, const Ros1Chunk& chunk);

}  // namespace raymoval
