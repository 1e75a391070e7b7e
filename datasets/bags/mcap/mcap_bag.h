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
#include "datasets/bags/decompress.h"
#include "datasets/bags/mcap/mcap_file.h"

namespace raymoval {

/// The place of a message in a MCAP file, as one number that increases along the chunks.
struct McapMessagePlace {
  /// The value of `chunk` for a message outside chunks. Such places come behind all others.
  static constexpr std::uint64_t kNoChunk = std::uint64_t{1} << 31;
  std::uint64_t chunk = kNoChunk;  ///< Number of the chunk in `McapContents::chunks`.
  std::uint64_t offset = 0;        ///< In the decompressed chunk, or in the file.

  [[nodiscard]] std::uint64_t number() const;
  static McapMessagePlace of(std::uint64_t number);
};

/// The contents of a MCAP file, without its messages.
struct McapContents {
  MessageTable messages;                        ///< Places are those of `McapMessagePlace`.
  std::vector<std::uint64_t> chunks;            ///< Where the record of each chunk begins.
  std::map<std::uint16_t, std::size_t> topics;  ///< Topic in `messages` of each channel.
};

/// Reads the contents of a MCAP file. If its summary and message indexes are whole and fit the
/// statistics, these are used. Else the file is read from front to back and each chunk is
/// decompressed once.
/// @param damage gets sentences on unreadable parts
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
  /// The first `most` bytes of the content of a message's record outside compressed chunks.
  [[nodiscard]] std::string in_file(const McapPlace& record, std::size_t most) const;
  [[nodiscard]] std::string in_chunk(const McapChunkPlace& chunk,
                                     const McapMessagePlace& place) const;

  McapFile file_;
  DamageNotes damage_;
  McapContents contents_;
  mutable ChunkStore chunks_;
};

}  // namespace raymoval
