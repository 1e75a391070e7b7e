// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
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
  std::string header;  ///< The fields with their lengths.
  std::uint64_t data_begin = 0;
  std::uint32_t data_size = 0;

  [[nodiscard]] std::uint64_t end() const { return data_begin + data_size; }
};

/// Bytes that records stand in, of which those from a place on can be asked for.
class Ros1Bytes {
 public:
  virtual ~Ros1Bytes() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// @param count at most what is there from `offset` on
  [[nodiscard]] virtual std::string read(std::uint64_t offset, std::uint64_t count) const = 0;
  /// "drive.bag: byte 4,117", to begin messages.
  [[nodiscard]] virtual std::string place(std::uint64_t offset) const = 0;
};

/// The bytes of a file.
class Ros1FileBytes : public Ros1Bytes {
 public:
  explicit Ros1FileBytes(const BagFile& file) : file_(file) {}
  [[nodiscard]] std::uint64_t size() const override { return file_.size(); }
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const override {
    return file_.read(offset, count);
  }
  [[nodiscard]] std::string place(std::uint64_t offset) const override {
    return file_.place(offset);
  }

 private:
  const BagFile& file_;
};

/// The bytes of a chunk, unpacked.
class Ros1ChunkBytes : public Ros1Bytes {
 public:
  /// @param chunk_place where the chunk stands, for messages
  Ros1ChunkBytes(std::string_view bytes, std::string chunk_place)
      : bytes_(bytes), chunk_place_(std::move(chunk_place)) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const override {
    return std::string(bytes_.substr(offset, count));
  }
  [[nodiscard]] std::string place(std::uint64_t offset) const override;

 private:
  std::string_view bytes_;
  std::string chunk_place_;
};

/// The record at `offset`; its data need not be there whole.
/// @throws DataError naming the byte if the record's header is cut, or its lengths do not fit
Ros1Record read_record(const Ros1Bytes& bytes, std::uint64_t offset);

/// What a record must have whole, besides its header. @throws DataError naming the byte if not
void check_data_is_there(const Ros1Bytes& bytes, const Ros1Record& record);

/// The fields of a header. @throws DataError if a length does not fit or a field has no name
/// @param where begins the message
void for_each_field(std::string_view header, const std::string& where,
                    const std::function<void(std::string_view name, std::string_view value)>& call);

/// The bytes of the field `name`; nothing if there is none. @throws DataError as `for_each_field`
std::optional<std::string> find_field(std::string_view header, std::string_view name,
                                      const std::string& where);
/// The same of a field that has to be there. @throws DataError
std::string text_field(std::string_view header, std::string_view name, const std::string& where);
std::uint32_t u32_field(std::string_view header, std::string_view name, const std::string& where);
std::uint64_t u64_field(std::string_view header, std::string_view name, const std::string& where);
/// Seconds and nanoseconds since 1970.
Nanoseconds time_field(std::string_view header, std::string_view name, const std::string& where);
/// The op of a record, which may be one that is unknown. @throws DataError
Ros1Op op_of(const Ros1Record& record, const std::string& where);

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
  std::string fields;  ///< All that its record's data says, as it stands there.
  bool operator==(const Ros1Connection&) const = default;
};

/// @throws DataError naming what its record lacks
Ros1Connection read_connection(const Ros1Bytes& bytes, const Ros1Record& record,
                               const std::string& where);

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
