// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/bag_file.h"
#include "datasets/bags/decompress.h"

namespace raymoval {

/// The bytes that a MCAP file begins and ends with.
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
/// Bytes of a record before its content: the op and the length of the content.
inline constexpr std::uint64_t kMcapHeadSize = 9;
/// Bytes of the content of a message before the published data.
inline constexpr std::uint64_t kMcapMessageHeadSize = 22;
/// Bytes of a whole footer with the magic behind it.
inline constexpr std::uint64_t kMcapEndSize = kMcapHeadSize + 20 + 8;

/// The type of a record. Unknown numbers are skipped; 0 is invalid.
enum class McapOp : std::uint8_t {
  kInvalid = 0x00,
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F,
};

/// Reads the fields of a record one after another. Numbers are little-endian.
class McapFields {
 public:
  /// @param where begins messages, such as "drive.mcap: byte 4,117: chunk"
  McapFields(std::string_view content, std::string where)
      : content_(content), where_(std::move(where)) {}
  /// @throws DataError if the content ends before; so do all others
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  /// Bytes behind a length of four bytes.
  std::string_view text() { return take(u32()); }
  std::string_view take(std::uint64_t count);
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool empty() const { return at_ == content_.size(); }

 private:
  std::uint64_t number(std::size_t size);
  std::string_view content_;
  std::string where_;
  std::size_t at_ = 0;
};

struct McapChannel {
  std::uint16_t id = 0, schema = 0;  ///< Schema 0 is none.
  std::string topic, encoding;
  bool operator==(const McapChannel&) const = default;
};

struct McapMessageHead {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  ///< Nanoseconds, mostly since 1970.
};

struct McapChunkHead {
  std::uint64_t unpacked_size = 0;
  std::uint32_t crc = 0;  ///< 0 is none.
  std::string compression;
  std::uint64_t packed_at = 0;  ///< Where in the content the compressed records begin.
  std::uint64_t packed_size = 0;
};

struct McapChunkIndex {
  std::uint64_t start = 0, length = 0;                  ///< Of the chunk's record.
  std::map<std::uint16_t, std::uint64_t> index_places;  ///< Of the message index of each channel.
};

McapChannel read_mcap_channel(std::string_view content, const std::string& where);
McapMessageHead read_mcap_message(std::string_view content, const std::string& where);
/// @param content its beginning is enough
McapChunkHead read_mcap_chunk(std::string_view content, const std::string& where);
McapChunkIndex read_mcap_chunk_index(std::string_view content, const std::string& where);

/// A record in a buffer: its place and its content.
struct McapRecord {
  McapOp op = McapOp::kInvalid;
  std::size_t begin = 0;
  std::string_view content;
};

/// Calls `call` with each record of `records`, in order.
/// @return the problem of the record at which it stopped; empty if all are whole
std::string for_each_record(std::string_view records,
                            const std::function<void(const McapRecord&)>& call);

/// A record in a file.
struct McapPlace {
  McapOp op = McapOp::kInvalid;
  std::uint64_t begin = 0;  ///< Of the record.
  std::uint64_t size = 0;   ///< Bytes of its content, which may be more than the file has.
  [[nodiscard]] std::uint64_t content() const { return begin + kMcapHeadSize; }
  [[nodiscard]] std::uint64_t end() const { return content() + size; }
};

/// A chunk of a file, its records still compressed.
struct McapChunkPlace {
  McapChunkHead head;
  std::uint64_t packed = 0;  ///< Where the compressed records begin in the file.
  std::string where;         ///< "drive.mcap: byte 4,117: chunk".
};

/// A MCAP file: its records and their places.
class McapFile {
 public:
  /// @throws DataError if it does not begin as MCAP does
  explicit McapFile(const std::filesystem::path& path);
  [[nodiscard]] const BagFile& bytes() const { return bytes_; }

  /// The record at `offset`, whose content may be truncated.
  /// @throws DataError if the file ends within its head, or for an op of 0
  [[nodiscard]] McapPlace record(std::uint64_t offset) const;
  /// Whether the file has the whole record.
  [[nodiscard]] bool is_whole(const McapPlace& record) const;
  /// The content of a record from byte `skip` on, at most `most` bytes.
  /// @param skip at most the record's size
  /// @throws DataError if the content is truncated, or the record is larger than 1 GiB
  [[nodiscard]] std::string content(
      const McapPlace& record, std::uint64_t skip = 0,
      std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// The beginning of its content.
  [[nodiscard]] std::string beginning(const McapPlace& record, std::uint64_t most) const;

  /// @throws DataError if its head is damaged or its compression is unknown
  [[nodiscard]] McapChunkPlace chunk(const McapPlace& record) const;
  /// The records in a chunk. The result has the records that can be decompressed, and the problem.
  /// @throws DataError if the stated size is beyond the limit (see `check_decompressed_size`)
  [[nodiscard]] Decompressed unpack(const McapChunkPlace& chunk) const;

  /// "drive.mcap: byte 4,117: chunk", to begin messages.
  [[nodiscard]] std::string where(const McapPlace& record) const;

 private:
  BagFile bytes_;
};

}  // namespace raymoval
