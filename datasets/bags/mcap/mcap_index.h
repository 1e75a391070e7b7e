// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "datasets/bags/chunks/message_table.h"
#include "datasets/bags/damage_notes.h"
#include "datasets/bags/mcap/mcap_file.h"

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
  std::uint64_t begin = 0;                         ///< Where it begins.
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

}  // namespace raymoval
