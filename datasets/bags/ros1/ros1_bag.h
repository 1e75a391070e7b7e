// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/bag_file.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/decompress.h"
#include "datasets/bags/ros1/ros1_file.h"

namespace raymoval {

/// The contents of a ROS 1 bag, without its messages.
struct Ros1Contents {
  std::map<std::uint32_t, std::size_t> topics;  ///< Topic in `messages` of each connection.
  std::vector<Ros1Chunk> chunks;                ///< In the order of the file.
  MessageTable messages;                        ///< Places are those of `message_place`.
};

/// A message's chunk and its byte there in one number, which increases along the file. A chunk
/// decompresses to less than 4 GiB because its size has 32 bits.
constexpr std::uint64_t message_place(std::size_t chunk, std::uint64_t offset) {
  return (static_cast<std::uint64_t>(chunk) << 32U) | offset;
}
constexpr std::size_t chunk_of(std::uint64_t place) {
  return static_cast<std::size_t>(place >> 32U);
}
constexpr std::uint64_t offset_of(std::uint64_t place) {
  return place & 0xFFFFFFFFU;
}

/// Reads the contents of a bag. If its index is whole and fits the chunks, it is used. Else the
/// chunks are read from front to back up to the end of the file.
/// @param notes gets sentences on unreadable parts
/// @throws DataError if the file is no ROS 1 bag of version 2.0, or encrypted; UnreadableError if
///   the disk fails
Ros1Contents read_contents(const BagFile& file, DamageNotes& notes);

/// A ROS 1 bag of version 2.0, not compressed or compressed by bz2 or lz4. A whole index is used; a
/// bag that was truncated or never closed is read from front to back when it is opened. Memory
/// holds 16 bytes per message and the chunks that were decompressed last.
class Ros1Bag : public Bag {
 public:
  /// @throws DataError as `read_contents`; UnreadableError if the disk fails
  explicit Ros1Bag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override {
    return contents_.messages.topics();
  }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return contents_.messages.at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return notes_.sentences(); }
  [[nodiscard]] const std::vector<Ros1Chunk>& chunks() const { return contents_.chunks; }

 private:
  std::string read_message(std::size_t topic, std::size_t index, std::size_t most) const;
  std::string read_from(const Ros1Bytes& chunk, std::uint64_t offset, std::size_t topic,
                        std::size_t most) const;

  BagFile file_;
  mutable DamageNotes notes_;
  mutable ChunkStore unpacked_;
  Ros1Contents contents_;
};

}  // namespace raymoval
