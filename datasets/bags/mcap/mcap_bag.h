// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
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
  std::uint64_t chunk = kNoChunk;  ///< Number of the chunk in `McapIndex::chunks`.
  std::uint64_t offset = 0;        ///< In the unpacked chunk, or in the file.

  [[nodiscard]] std::uint64_t number() const;
  static McapMessagePlace of(std::uint64_t number);
};

/// The end of a MCAP file, if it is whole.
struct McapSummary {
  std::vector<McapSchema> schemas;
  std::vector<McapChannel> channels;
  std::map<std::uint64_t, McapChunkIndex> chunks;  ///< By where the chunk begins.
  std::optional<std::uint64_t> messages;           ///< By the statistics; nothing if they say none.
};

/// Whether the file ends with a footer, as one does that was written to its end.
bool has_mcap_footer(const McapFile& file);

/// @return nothing if the file has no summary, or one that is damaged. @throws UnreadableError
std::optional<McapSummary> read_mcap_summary(const McapFile& file);

/// What is in a MCAP file.
class McapIndex {
 public:
  /// Uses the summary and the message indexes where they agree with each other and with the file;
  /// elsewhere each chunk is unpacked once. What cannot be read is said to `damage`.
  /// @throws UnreadableError if the disk fails
  McapIndex(const McapFile& file, DamageNotes& damage);

  [[nodiscard]] const MessageTable& messages() const { return messages_; }
  /// Where the record of each chunk begins.
  [[nodiscard]] const std::vector<std::uint64_t>& chunks() const { return chunks_; }
  /// The topic of a channel; nothing if the file has no such channel.
  [[nodiscard]] std::optional<std::size_t> topic_of(std::uint16_t channel) const;

 private:
  class Walk;
  MessageTable messages_;
  std::vector<std::uint64_t> chunks_;
  std::map<std::uint16_t, std::size_t> topics_;
};

/// A time as MCAP writes it; what is beyond the year 2262 counts as that.
Nanoseconds mcap_time(std::uint64_t time);

/// A recording in a MCAP file.
class McapBag : public Bag {
 public:
  /// @throws DataError if it is no MCAP file; UnreadableError
  explicit McapBag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.bytes().path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override {
    return index_.messages().topics();
  }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return index_.messages().at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

 private:
  /// The first `most` bytes that were published, or all if there are fewer.
  [[nodiscard]] std::string read(std::size_t topic, std::size_t index, std::size_t most) const;
  /// The same of a message whose record stands in the file as it is.
  [[nodiscard]] std::string in_file(const McapPlace& record, std::size_t topic,
                                    const MessageTable::Message& message, std::size_t most) const;
  [[nodiscard]] std::string in_chunk(const McapChunkPlace& chunk, std::size_t topic,
                                     const MessageTable::Message& message) const;
  /// The chunk, unpacked; its checksum is looked at when it is asked for the first time.
  [[nodiscard]] ChunkStore::Chunk unpacked(const McapChunkPlace& chunk, std::uint64_t number,
                                           std::string& problem) const;
  [[nodiscard]] bool is_checked(std::uint64_t chunk) const;
  void check_head(std::string_view content, std::size_t topic, const MessageTable::Message& message,
                  const std::string& where) const;
  [[nodiscard]] bool is_cdr(std::size_t topic) const {
    return topics()[topic].encoding == MessageEncoding::kCdr;
  }

  McapFile file_;
  DamageNotes damage_;
  McapIndex index_;
  mutable ChunkStore chunks_;
  mutable std::mutex checking_;
  mutable std::vector<bool> checked_;  ///< Of each chunk, whether its checksum was found right.
};

}  // namespace raymoval
