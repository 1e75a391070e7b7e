// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/chunks/bag_file.h"
#include "datasets/bags/chunks/unpack.h"
#include "datasets/bags/mcap/mcap_records.h"

namespace raymoval {

/// A record that stands in a file.
struct McapPlace {
  McapOp op = McapOp::kInvalid;
  std::uint64_t begin = 0;  ///< Of the record.
  std::uint64_t size = 0;   ///< Bytes of its content, which may be more than the file has.
  [[nodiscard]] std::uint64_t content() const { return begin + kMcapHeadSize; }
  [[nodiscard]] std::uint64_t end() const { return content() + size; }
};

/// A chunk of a file, its records still packed.
struct McapChunkPlace {
  McapChunkHead head;
  std::uint64_t packed = 0;  ///< Where the packed records begin in the file.
  std::string where;         ///< "drive.mcap: byte 4,117: chunk".
};

/// A MCAP file: what stands where in it.
class McapFile {
 public:
  /// @throws DataError if it does not begin as MCAP does
  explicit McapFile(const std::filesystem::path& path);
  [[nodiscard]] const BagFile& bytes() const { return bytes_; }

  /// The record at `offset`, whose content may be cut.
  /// @throws DataError if the file ends within its head, or for an op of 0
  [[nodiscard]] McapPlace record(std::uint64_t offset) const;
  /// Whether the file has the whole record.
  [[nodiscard]] bool is_whole(const McapPlace& record) const;
  /// What a record holds from byte `skip` on, at most `most` bytes of it.
  /// @param skip at most the record's size
  /// @throws DataError if that is cut, or the record larger than 1 GiB
  [[nodiscard]] std::string content(
      const McapPlace& record, std::uint64_t skip = 0,
      std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// The beginning of what it holds.
  [[nodiscard]] std::string beginning(const McapPlace& record, std::uint64_t most) const;

  /// @throws DataError if its head is damaged or its compression is unknown
  [[nodiscard]] McapChunkPlace chunk(const McapPlace& record) const;
  /// The records in a chunk. What is wrong with them is told in the answer, with what can be had.
  /// @param check whether their checksum is looked at
  /// @throws DataError if it is said to have more than is allowed (see `check_unpacked_size`)
  [[nodiscard]] Unpacked unpack(const McapChunkPlace& chunk, bool check = true) const;

  /// "drive.mcap: byte 4,117: chunk", to begin messages.
  [[nodiscard]] std::string where(const McapPlace& record) const;

 private:
  BagFile bytes_;
};

/// What an op is called.
std::string_view mcap_op_name(McapOp op);

}  // namespace raymoval
