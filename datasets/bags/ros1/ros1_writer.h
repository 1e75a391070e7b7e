// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/file_writer.h"
#include "datasets/bags/ros1/chunk.h"
#include "datasets/bags/ros1/records.h"

namespace raymoval {

/// Writes a ROS 1 bag of version 2.0 chunk by chunk, with its index, as rosbag writes it. Only the
/// chunk at hand is in memory, and 8 bytes for each connection that each chunk has messages of.
class Ros1Writer {
 public:
  /// Begins the bag. @param file is empty, and outlives this object. Everything below throws
  ///   DataError as its members do.
  explicit Ros1Writer(FileWriter& file);

  void begin_chunk(Ros1Compression compression);
  /// Adds a message to the chunk. The connection is written before its first message.
  /// @param connection the same for each of its messages
  /// @param time from 1970 to 2106, which is what ROS 1 can write. @throws DataError if it is not,
  ///   and for a chunk beyond 4 GiB
  void message(const Ros1Connection& connection, Nanoseconds time, std::string_view bytes);
  /// Bytes of the chunk so far, not packed.
  [[nodiscard]] std::size_t chunk_size() const { return chunk_.size(); }
  /// Packs the chunk and writes it with its index.
  void end_chunk();
  /// Writes the index of all chunks. The bag is whole after this.
  void finish();

 private:
  struct Entry {
    Nanoseconds time = 0;
    std::uint32_t offset = 0;
  };
  struct ChunkInfo {
    std::uint64_t begin = 0;
    Nanoseconds first = 0, last = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  ///< Connection, messages.
  };

  void append(std::string_view bytes);
  void write_chunk_index(ChunkInfo& info);
  [[nodiscard]] std::string bag_header(std::uint64_t index_begin) const;

  FileWriter& file_;
  std::uint64_t size_ = 0;
  std::map<std::uint32_t, Ros1Connection> connections_;
  std::vector<ChunkInfo> infos_;
  Ros1Compression compression_ = Ros1Compression::kNone;
  std::string chunk_;
  std::map<std::uint32_t, std::vector<Entry>> entries_;  ///< Of the chunk at hand.
};

}  // namespace raymoval
