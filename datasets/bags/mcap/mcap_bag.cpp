// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/decompress.h"
#include "datasets/bags/mcap/mcap_file.h"

namespace raymoval {
namespace {

constexpr std::uint64_t kOffsetBits = 32;
constexpr std::uint64_t kNoChunkBit = std::uint64_t{1} << 63U;

MessageEncoding encoding_of(const std::string& name) {
  if (name == "cdr") return MessageEncoding::kCdr;
  if (name == "ros1") return MessageEncoding::kRos1;
  return MessageEncoding::kOther;
}

/// A time of MCAP; times beyond the year 2262 are clamped.
Nanoseconds mcap_time(std::uint64_t time) {
  constexpr auto kLast = std::numeric_limits<Nanoseconds>::max();
  return static_cast<Nanoseconds>(std::min(time, static_cast<std::uint64_t>(kLast)));
}

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
  std::vector<std::uint64_t> chunks;            ///< Where the record of each chunk begins.
  std::map<std::uint16_t, std::size_t> topics;  ///< Topic of each channel.
};

/// Whether the file ends with a footer. A truncated file does not.
bool has_footer(const McapFile& file) {
  const BagFile& bytes = file.bytes();
  if (bytes.size() < kMcapMagic.size() + kMcapEndSize) return false;
  const auto footer = if_whole([&] { return file.record(bytes.size() - kMcapEndSize); });
  return footer && footer->op == McapOp::kFooter && footer->size == 20 &&
         bytes.read(bytes.size() - kMcapMagic.size(), kMcapMagic.size()) == kMcapMagic;
}

/// The records of a file other than its messages.
struct McapDirectory {
  std::map<std::uint16_t, std::string> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::map<std::uint64_t, McapChunkIndex> chunks;  ///< By where the chunk begins.
  std::optional<std::uint64_t> messages;           ///< By the statistics, if they have it.
};

/// Reads the contents of a MCAP file. If its summary and message indexes are whole and fit the
/// statistics, these are used. Else the file is read from front to back and each chunk is
/// decompressed once. Unreadable parts become sentences in `damage`.
class McapReader {
 public:
  McapReader(const McapFile& file, DamageNotes& damage) : file_(file), damage_(damage) {
    // Each message takes some bytes of the file, however well it is compressed.
    most_messages_ = file.bytes().size() / 2 + 65536;
  }

  /// @param messages gets them; places are those of `McapMessagePlace`
  McapContents read(MessageTable& messages) {
    if (!damage_in([&] { read_summary(); }).empty()) known_ = {};
    if (!if_whole([&] { return use_indexes(); }).value_or(false)) {
      contents_ = {};
      table_ = {};
      read_front_to_back();
    }
    for (const auto& [id, channel] : known_.channels) topic(channel);
    table_.finish();
    messages = std::move(table_);
    return std::move(contents_);
  }

 private:
  [[nodiscard]] std::string name() const { return file_.bytes().path().string(); }

  /// @throws DataError if there is no summary, or a damaged one
  void read_summary() {
    const BagFile& bytes = file_.bytes();
    if (!has_footer(file_)) throw DataError(name() + ": has no footer.");
    const std::uint64_t footer_begin = bytes.size() - kMcapEndSize;
    const std::string end = bytes.read(footer_begin, kMcapEndSize);
    McapFields footer(std::string_view(end).substr(kMcapHeadSize), name());
    const std::uint64_t begin = footer.u64();
    footer.u64();  // Where the summary's own table of contents begins.
    const std::uint32_t crc = footer.u32();
    if (begin < kMcapMagic.size() || begin >= footer_begin) {
      throw DataError(name() + ": has no summary.");
    }
    McapPlace all;
    all.begin = begin - kMcapHeadSize;  // So that its content is the summary.
    all.size = footer_begin - begin;
    const std::string records = file_.content(all);
    // The checksum covers the summary and the footer up to the checksum itself.
    const std::string_view head = std::string_view(end).substr(0, kMcapHeadSize + 16);
    if (crc != 0 && crc != crc32_of(head, crc32_of(records))) {
      throw DataError(name() + ": the summary is damaged.");
    }
    const std::string where = name() + ": summary";
    const std::string problem = for_each_record(
        records, [&](const McapRecord& record) { add_record(record.op, record.content, where); });
    if (!problem.empty()) throw DataError(where + ": " + problem + ".");
  }

  /// Adds a record that is no message.
  void add_record(McapOp op, std::string_view content, const std::string& where) {
    McapFields fields(content, where);
    if (op == McapOp::kSchema) {
      const std::uint16_t id = fields.u16();
      known_.schemas.try_emplace(id, fields.text());
    } else if (op == McapOp::kChannel) {
      add_channel(read_mcap_channel(content, where));
    } else if (op == McapOp::kChunkIndex) {
      McapChunkIndex index = read_mcap_chunk_index(content, where);
      const std::uint64_t start = index.start;
      known_.chunks.insert_or_assign(start, std::move(index));
    } else if (op == McapOp::kStatistics) {
      // Some writers leave the count empty.
      const std::uint64_t count = fields.u64();
      known_.messages = count == 0 ? std::nullopt : std::optional(count);
    }
  }

  void add_channel(const McapChannel& channel) {
    const auto [found, is_new] = known_.channels.try_emplace(channel.id, channel);
    if (is_new || found->second == channel) return;
    damage_.add(name() + ": channel " + std::to_string(channel.id) + " is both '" +
                found->second.topic + "' and '" + channel.topic +
                "'; its messages are read as the first.");
  }

  std::size_t topic(const McapChannel& channel) {
    const auto known = contents_.topics.find(channel.id);
    if (known != contents_.topics.end()) return known->second;
    const auto schema = known_.schemas.find(channel.schema);
    const std::string type = schema == known_.schemas.end() ? "" : ros1_type_name(schema->second);
    const std::size_t topic = table_.topic(channel.topic, type, encoding_of(channel.encoding));
    contents_.topics.emplace(channel.id, topic);
    return topic;
  }

  void add(std::size_t topic, std::uint64_t log_time, const McapMessagePlace& place) {
    if (table_.size() >= most_messages_) {
      throw DataError(name() + ": has more than " + grouped_text(most_messages_) +
                      " messages, which cannot be in so few bytes; the file is damaged.");
    }
    table_.add(topic, {mcap_time(log_time), place.number()});
  }

  // --- From the message indexes ---

  /// Takes all messages from the indexes that the summary names. @return whether the indexes are
  /// whole, fit their chunks, and hold the number of messages of the statistics
  bool use_indexes() {
    if (!known_.messages) return false;
    for (const auto& [begin, index] : known_.chunks) {
      const McapPlace record = file_.record(begin);
      if (record.op != McapOp::kChunk || record.end() - begin != index.length) return false;
      contents_.chunks.push_back(begin);
      const std::uint64_t size = file_.chunk(record).head.unpacked_size;
      for (const auto& [channel, place] : index.index_places) {
        if (!use_index(file_.record(place), channel, size)) return false;
      }
    }
    return *known_.messages == table_.size();
  }

  bool use_index(const McapPlace& record, std::uint16_t id, std::uint64_t chunk_size) {
    const auto channel = known_.channels.find(id);
    if (record.op != McapOp::kMessageIndex || channel == known_.channels.end()) return false;
    const std::uint16_t schema = channel->second.schema;
    if (schema != 0 && !known_.schemas.contains(schema)) return false;
    const std::string content = file_.content(record);
    McapFields fields(content, file_.where(record));
    if (fields.u16() != id) return false;
    McapFields entries(fields.text(), file_.where(record));
    while (!entries.empty()) {
      const std::uint64_t log_time = entries.u64(), offset = entries.u64();
      if (offset >= std::min(chunk_size, std::uint64_t{1} << kOffsetBits)) return false;
      add(topic(channel->second), log_time, {contents_.chunks.size() - 1, offset});
    }
    return true;
  }

  // --- From front to back ---

  void read_front_to_back() {
    for (std::uint64_t at = kMcapMagic.size(); at < file_.bytes().size() && !has_end_;) {
      const std::string damage = damage_in([&] { at = read_next(at); });
      if (damage.empty()) continue;
      damage_.add(damage);
      // Continue at the next chunk behind the damage that the summary lists.
      const auto next = known_.chunks.upper_bound(at);
      at = next == known_.chunks.end() ? file_.bytes().size() : next->first;
    }
    if (damage_.empty() && !(has_end_ && has_footer(file_))) {
      damage_.add(name() + ": ends at byte " + grouped_text(file_.bytes().size()) +
                  " without the footer of a MCAP file: it is truncated, or its recorder was "
                  "stopped; everything before it is read.");
    }
    const std::uint64_t found = table_.size();
    if (damage_.empty() && known_.messages && *known_.messages != found) {
      damage_.add(name() + ": should have " + counted_text(*known_.messages, "message") +
                  " by its statistics, and has " + grouped_text(found) + ".");
    }
  }

  /// Reads the record at `at`. @return where to continue
  std::uint64_t read_next(std::uint64_t at) {
    const McapPlace record = file_.record(at);
    if (record.op == McapOp::kDataEnd || record.op == McapOp::kFooter) {
      has_end_ = true;
      return at;
    }
    if (record.op == McapOp::kChunk) walk_chunk(record);
    if (!file_.is_whole(record)) {
      throw DataError(file_.where(record) + " of " + grouped_text(record.size) +
                      " bytes goes beyond the end of the file (" +
                      grouped_text(file_.bytes().size()) +
                      " bytes), which is truncated or damaged; everything before it is read.");
    }
    if (record.op == McapOp::kMessage) {
      add_message(file_.beginning(record, kMcapMessageHeadSize), file_.where(record),
                  {McapMessagePlace::kNoChunk, record.begin});
    } else if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) {
      add_record(record.op, file_.content(record), file_.where(record));
    }
    return record.end();
  }

  void walk_chunk(const McapPlace& record) {
    const std::uint64_t number = contents_.chunks.size();
    const McapChunkPlace place = file_.chunk(record);
    contents_.chunks.push_back(record.begin);
    const Decompressed unpacked = file_.unpack(place);
    const std::string cut = for_each_record(unpacked.bytes, [&](const McapRecord& inner) {
      if (inner.op == McapOp::kMessage) {
        add_message(inner.content, place.where, {number, inner.begin});
      } else if (inner.op == McapOp::kSchema || inner.op == McapOp::kChannel) {
        add_record(inner.op, inner.content, place.where);
      }
    });
    const std::string& problem = unpacked.problem.empty() ? cut : unpacked.problem;
    if (!problem.empty())
      damage_.add(place.where + ": " + problem + "; everything before it is read.");
  }

  /// @param head the beginning of the message's content
  void add_message(std::string_view head, const std::string& where, const McapMessagePlace& place) {
    const McapMessageHead message = read_mcap_message(head, where);
    const auto channel = known_.channels.find(message.channel);
    if (channel == known_.channels.end()) {
      damage_.add(where + " is of channel " + std::to_string(message.channel) +
                  ", which the file does not describe before it; left out.");
      return;
    }
    add(topic(channel->second), message.log_time, place);
  }

  const McapFile& file_;
  DamageNotes& damage_;
  std::uint64_t most_messages_ = 0;
  bool has_end_ = false;
  McapDirectory known_;
  McapContents contents_;
  MessageTable table_;
};

std::uint64_t McapMessagePlace::number() const {
  return chunk == kNoChunk ? kNoChunkBit | offset : chunk << kOffsetBits | offset;
}

McapMessagePlace McapMessagePlace::of(std::uint64_t number) {
  if ((number & kNoChunkBit) != 0) return {kNoChunk, number & ~kNoChunkBit};
  return {number >> kOffsetBits, number & ((std::uint64_t{1} << kOffsetBits) - 1)};
}

/// A recording in a MCAP file.
class McapBag : public IndexedBag {
 public:
  /// @throws DataError if it is no MCAP file; UnreadableError
  explicit McapBag(const std::filesystem::path& path)
      : file_(path), contents_(McapReader(file_, damage_).read(table_)) {}

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.bytes().path(); }
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;

 private:
  /// The first `most` bytes of the content of a message's record outside compressed chunks.
  [[nodiscard]] std::string in_file(const McapPlace& record, std::size_t most) const;
  [[nodiscard]] std::string in_chunk(const McapChunkPlace& chunk,
                                     const McapMessagePlace& place) const;

  McapFile file_;
  McapContents contents_;
  mutable ChunkStore chunks_;
};

std::string McapBag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  const MessageTable::Message& message = table_.at(topic, index);
  const McapMessagePlace place = McapMessagePlace::of(message.place);
  const bool is_alone = place.chunk == McapMessagePlace::kNoChunk;
  const McapPlace record = file_.record(is_alone ? place.offset : contents_.chunks[place.chunk]);
  const std::string where = file_.where(record);
  std::string bytes = is_alone ? in_file(record, most) : in_chunk(file_.chunk(record), place);
  const McapMessageHead head = read_mcap_message(bytes, where);
  const auto of_topic = contents_.topics.find(head.channel);
  if (of_topic == contents_.topics.end() || of_topic->second != topic ||
      mcap_time(head.log_time) != message.recorded) {
    throw DataError(
        where + ": the index leads to byte " + grouped_text(place.offset) +
        ", where there is no such message; the file is damaged. `mcap recover` rewrites it.");
  }
  bytes.erase(0, kMcapMessageHeadSize);
  bytes = decompressed_if_needed(std::move(bytes),
                                 topics()[topic].encoding == MessageEncoding::kCdr, where);
  if (bytes.size() > most) bytes.resize(most);
  return bytes;
}

std::string McapBag::in_file(const McapPlace& record, std::size_t most) const {
  const std::uint64_t head = std::min<std::uint64_t>(most, record.size) + kMcapMessageHeadSize;
  std::string bytes = file_.content(record, 0, head);
  // A message that is compressed by itself is not read in part.
  const bool is_compressed = bytes.size() > kMcapMessageHeadSize &&
                             is_zstd(std::string_view(bytes).substr(kMcapMessageHeadSize));
  return is_compressed ? file_.content(record) : bytes;
}

std::string McapBag::in_chunk(const McapChunkPlace& chunk, const McapMessagePlace& place) const {
  std::string problem;
  const ChunkStore::Chunk kept = chunks_.get(place.chunk, [&] {
    Decompressed all = file_.unpack(chunk);
    problem = std::move(all.problem);
    return std::move(all.bytes);
  });
  const std::string_view bytes = *kept;
  if (place.offset + kMcapHeadSize <= bytes.size()) {
    McapFields head(bytes.substr(place.offset), chunk.where);
    const auto op = static_cast<McapOp>(head.u8());
    const std::uint64_t size = head.u64();
    if (op == McapOp::kMessage && size <= bytes.size() - place.offset - kMcapHeadSize) {
      return std::string(head.take(size));
    }
  }
  throw DataError(chunk.where + ": " +
                  (problem.empty() ? "the message at byte " + grouped_text(place.offset) +
                                         " in it is incomplete"
                                   : problem) +
                  "; the file is damaged. Copy it again.");
}

}  // namespace

std::unique_ptr<Bag> open_mcap(const std::filesystem::path& path) {
  return std::make_unique<McapBag>(path);
}

}  // namespace raymoval
