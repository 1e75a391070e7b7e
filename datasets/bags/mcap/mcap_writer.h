// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/file_writer.h"
#include "datasets/bags/mcap/mcap_records.h"

namespace raymoval {

/// Writes a MCAP file record by record, with message indexes and a summary. Only the chunk at hand
/// is in memory, and a few tens of bytes for each chunk and each channel in it.
class McapWriter {
 public:
  /// Begins the file. @param file is empty, and outlives this object. Everything below throws
  ///   DataError as its members do.
  explicit McapWriter(FileWriter& file);

  /// Adds a record: a header, schema, channel, message, attachment, metadata or one of another
  /// kind, to the chunk if one is begun. Schemas and channels go into the summary as well.
  void record(McapOp op, std::string_view content);
  /// Begins a chunk. @param compression "lz4", "zstd" or nothing
  void begin_chunk(std::string compression);
  /// The records of the chunk so far, not packed.
  [[nodiscard]] const std::string& chunk() const { return chunk_; }
  /// Packs the chunk and writes it with its message indexes.
  /// @param packed what it packs to, if that is known already; else empty
  void end_chunk(std::string packed = {});
  /// Writes the summary. The file is whole after this.
  void finish();

 private:
  struct ChunkInfo {
    std::uint64_t start = 0, length = 0, first = 0, last = 0, index_length = 0;
    std::uint64_t packed = 0, unpacked = 0;
    std::map<std::uint16_t, std::uint64_t> index_places;
    std::string compression;
  };
  struct Group {
    McapOp op;
    std::string records;
  };

  void append(std::string_view bytes);
  void note(McapOp op, std::string_view content, std::uint64_t length);
  void note_message(std::string_view content);
  void write_indexes(ChunkInfo& info);
  [[nodiscard]] std::string statistics() const;
  [[nodiscard]] std::string chunk_indexes() const;

  FileWriter& file_;
  std::uint64_t size_ = 0;
  std::map<std::uint16_t, std::string> schemas_, channels_;  ///< Their contents.
  std::map<std::uint16_t, std::uint64_t> counts_;            ///< Messages of each channel.
  std::uint64_t messages_ = 0, first_ = 0, last_ = 0;
  std::uint32_t attachments_ = 0, metadata_ = 0;
  std::string attachment_indexes_, metadata_indexes_;
  std::vector<ChunkInfo> chunks_;
  bool in_chunk_ = false;
  std::string compression_, chunk_;
  std::map<std::uint16_t, std::vector<McapMessageIndex::Entry>> entries_;  ///< Of the chunk.
};

}  // namespace raymoval
