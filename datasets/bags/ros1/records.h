// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/chunks/bag_file.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// The line that a ROS 1 bag begins with.
inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
/// Bytes of the bag's own record without its two lengths: its data fills up what its header leaves,
/// so that a header that is rewritten at the end has room.
inline constexpr std::uint32_t kBagHeaderRoom = 4096;

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

}  // namespace raymoval
