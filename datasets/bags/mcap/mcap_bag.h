// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/mcap/mcap_file.h"
#include "datasets/bags/unpack.h"

namespace raymoval {

/// Where a message of a MCAP file stands, as one number that grows along the chunks.
struct McapMessagePlace {
  /// What `chunk` is for a message that stands in no chunk. Such places come behind all others.
  static constexpr std::uint64_t kNoChunk = std::uint64_t{1} << 31;
  std::uint64_t chunk = kNoChunk;  ///< Number of the chunk in `McapContents::chunks`.
  std::uint64_t offset = 0;        ///< In the unpacked chunk, or in the file.

  [[nodiscard]] std::uint64_t number() const;
  static McapMessagePlace of(std::uint64_t number);
};

/// What a MCAP file holds, without its messages.
struct McapContents {
  MessageTable messages;                        ///< Places are those of `McapMessagePlace`.
  std::vector<std::uint64_t> chunks;            ///< Where the record of each chunk begins.
  std::map<std::uint16_t, std::size_t> topics;  ///< Topic in `messages` of each channel.
};

/// Reads what is in a MCAP file: from its summary and message indexes, if these are whole and hold
/// what the statistics say; else from front to back, where each chunk is unpacked once.
/// @param damage gets what could not be read
/// @throws UnreadableError if the disk fails
McapContents read_contents(const McapFile& file, DamageNotes& damage);

/// A recording in a MCAP file.
class McapBag : public Bag {
 public:
  /// @throws DataError if it is no MCAP file; UnreadableError
  explicit McapBag(const std::filesystem::path& path)
      : file_(path), contents_(read_contents(file_, damage_)) {}

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.bytes().path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override {
    return contents_.messages.topics();
  }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return contents_.messages.at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

 private:
  /// The content of a message's record that stands in the file as it is, at most `most` bytes.
  [[nodiscard]] std::string in_file(const McapPlace& record, std::size_t most) const;
  [[nodiscard]] std::string in_chunk(const McapChunkPlace& chunk,
                                     const McapMessagePlace& place) const;

  McapFile file_;
  DamageNotes damage_;
  McapContents contents_;
  mutable ChunkStore chunks_;
};

}  // namespace raymoval
