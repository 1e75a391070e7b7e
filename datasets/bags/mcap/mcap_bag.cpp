// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_bag.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/bag_file.h"

namespace raymoval {
namespace {

/// The statistics' count of messages; nothing if they are left empty, as some writers do.
std::optional<std::uint64_t> stated_messages(std::string_view content, const std::string& where) {
  const std::uint64_t count = McapFields(content, where).u64();
  return count == 0 ? std::nullopt : std::optional(count);
}

void add_record(McapSummary& summary, const McapRecord& record, const std::string& where) {
  if (record.op == McapOp::kSchema) {
    summary.schemas.push_back(read_mcap_schema(record.content, where));
  } else if (record.op == McapOp::kChannel) {
    summary.channels.push_back(read_mcap_channel(record.content, where));
  } else if (record.op == McapOp::kChunkIndex) {
    McapChunkIndex index = read_mcap_chunk_index(record.content, where);
    const std::uint64_t start = index.start;
    summary.chunks.insert_or_assign(start, std::move(index));
  } else if (record.op == McapOp::kStatistics) {
    summary.messages = stated_messages(record.content, where);
  }
}

McapSummary read_summary(const McapFile& file) {
  const BagFile& bytes = file.bytes();
  const std::string name = bytes.path().string();
  if (!has_mcap_footer(file)) throw DataError(name + ": has no footer.");
  const std::uint64_t footer_begin = bytes.size() - kMcapEndSize;
  const std::string end = bytes.read(footer_begin, kMcapEndSize);
  const McapPlace place = file.record(footer_begin);
  const McapFooter footer = read_mcap_footer(file.content(place), file.where(place));
  if (footer.summary_start < kMcapMagic.size() || footer.summary_start >= footer_begin) {
    throw DataError(name + ": has no summary.");
  }
  McapPlace all;
  all.begin = footer.summary_start - kMcapHeadSize;  // So that its content is the summary.
  all.size = footer_begin - footer.summary_start;
  const std::string records = file.content(all);
  // The footer's own checksum is the last of what it is over.
  const std::uint32_t crc =
      crc32_of(std::string_view(end).substr(0, kMcapHeadSize + 16), crc32_of(records));
  if (footer.crc != 0 && footer.crc != crc) throw DataError(name + ": the summary is damaged.");

  McapSummary summary;
  const std::string where = name + ": summary";
  const std::string problem = for_each_record(
      records, [&](const McapRecord& record) { add_record(summary, record, where); });
  if (!problem.empty()) throw DataError(where + ": " + problem + ".");
  return summary;
}

}  // namespace

bool has_mcap_footer(const McapFile& file) {
  const BagFile& bytes = file.bytes();
  if (bytes.size() < kMcapMagic.size() + kMcapEndSize) return false;
  const auto footer = if_whole([&] { return file.record(bytes.size() - kMcapEndSize); });
  return footer && footer->op == McapOp::kFooter && footer->size == 20 &&
         bytes.read(bytes.size() - kMcapMagic.size(), kMcapMagic.size()) == kMcapMagic;
}

std::optional<McapSummary> read_mcap_summary(const McapFile& file) {
  return if_whole([&] { return read_summary(file); });
}

namespace {

constexpr std::uint64_t kOffsetBits = 32;
constexpr std::uint64_t kNoChunkBit = std::uint64_t{1} << 63U;

MessageEncoding encoding_of(const std::string& name) {
  if (name == "cdr") return MessageEncoding::kCdr;
  if (name == "ros1") return MessageEncoding::kRos1;
  return MessageEncoding::kOther;
}

}  // namespace

std::uint64_t McapMessagePlace::number() const {
  return chunk == kNoChunk ? kNoChunkBit | offset : chunk << kOffsetBits | offset;
}

McapMessagePlace McapMessagePlace::of(std::uint64_t number) {
  if ((number & kNoChunkBit) != 0) return {kNoChunk, number & ~kNoChunkBit};
  return {number >> kOffsetBits, number & ((std::uint64_t{1} << kOffsetBits) - 1)};
}

Nanoseconds mcap_time(std::uint64_t time) {
  constexpr auto kLast = std::numeric_limits<Nanoseconds>::max();
  return static_cast<Nanoseconds>(std::min(time, static_cast<std::uint64_t>(kLast)));
}

/// One walk over a file from its front to its back.
class McapIndex::Walk {
 public:
  Walk(McapIndex& index, const McapFile& file, DamageNotes& damage,
       const std::optional<McapSummary>& summary, bool trust)
      : index_(index), file_(file), damage_(damage), summary_(summary), trust_(trust) {
    // Each message takes some bytes of the file, however well it is packed.
    most_messages_ = file.bytes().size() / 2 + 65536;
  }

  /// @return whether the message indexes that were used hold what the statistics say
  bool run() {
    if (summary_) {
      for (const McapSchema& schema : summary_->schemas) add_schema(schema);
      for (const McapChannel& channel : summary_->channels) add_channel(channel);
    }
    for (std::uint64_t at = kMcapMagic.size(); at != 0;) at = step(at);
    for (const auto& [id, channel] : channels_) topic(channel);
    if (damage_.empty() && !(has_end_ && has_mcap_footer(file_))) note_no_end();
    const std::uint64_t found = index_.messages_.size();
    if (summary_ && summary_->messages && *summary_->messages != found) {
      if (used_indexes_) return false;
      if (damage_.empty()) note_other_count(*summary_->messages, found);
    }
    index_.messages_.finish();
    return true;
  }

 private:
  /// Reads the record at `at`. @return where to go on; 0 is the end
  std::uint64_t step(std::uint64_t at) {
    if (at == file_.bytes().size()) return 0;
    McapPlace record;
    try {
      record = file_.record(at);
      if (record.op == McapOp::kDataEnd || record.op == McapOp::kFooter) {
        has_end_ = true;
        return 0;
      }
      if (record.op == McapOp::kChunk) return chunk(record);
      if (!file_.is_whole(record)) throw_cut(record);
      read_record(record);
      return record.end();
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      damage_.add(error.what());
      return next_chunk_behind(at);
    }
  }

  [[noreturn]] void throw_cut(const McapPlace& record) const {
    throw DataError(file_.where(record) + " of " + grouped_text(record.size) +
                    " bytes goes beyond the end of the file (" +
                    grouped_text(file_.bytes().size()) +
                    " bytes), which is cut or damaged; what stands before is read.");
  }

  void note_no_end() {
    damage_.add(file_.bytes().path().string() + ": ends at byte " +
                grouped_text(file_.bytes().size()) +
                " without the footer of a MCAP file: it is cut, or its recorder was stopped; what "
                "stands before is read.");
  }

  void note_other_count(std::uint64_t stated, std::uint64_t found) {
    damage_.add(file_.bytes().path().string() + ": should have " + counted_text(stated, "message") +
                " by its statistics, and has " + grouped_text(found) + ".");
  }

  /// Where the summary knows the next chunk behind damage; 0 if it knows none.
  std::uint64_t next_chunk_behind(std::uint64_t at) const {
    if (!summary_) return 0;
    const auto next = summary_->chunks.upper_bound(at);
    return next == summary_->chunks.end() ? 0 : next->first;
  }

  void read_record(const McapPlace& record) {
    if (record.op == McapOp::kSchema) {
      add_schema(read_mcap_schema(file_.content(record), file_.where(record)));
    } else if (record.op == McapOp::kChannel) {
      add_channel(read_mcap_channel(file_.content(record), file_.where(record)));
    } else if (record.op == McapOp::kMessage) {
      add_message(file_.beginning(record, kMcapMessageHeadSize), file_.where(record),
                  {McapMessagePlace::kNoChunk, record.begin});
    }
  }

  void add_schema(const McapSchema& schema) { schemas_.try_emplace(schema.id, schema.name); }

  void add_channel(const McapChannel& channel) {
    const auto [found, is_new] = channels_.try_emplace(channel.id, channel);
    if (is_new || found->second == channel) return;
    damage_.add(file_.bytes().path().string() + ": channel " + std::to_string(channel.id) +
                " is both '" + found->second.topic + "' and '" + channel.topic +
                "'; its messages are read as the first.");
  }

  std::size_t topic(const McapChannel& channel) {
    const auto known = index_.topics_.find(channel.id);
    if (known != index_.topics_.end()) return known->second;
    const auto schema = schemas_.find(channel.schema);
    const std::string type = schema == schemas_.end() ? "" : ros1_type_name(schema->second);
    const std::size_t topic =
        index_.messages_.topic(channel.topic, type, encoding_of(channel.encoding));
    index_.topics_.emplace(channel.id, topic);
    return topic;
  }

  /// @param head the beginning of the message's content
  void add_message(std::string_view head, const std::string& where, const McapMessagePlace& place) {
    const McapMessageHead message = read_mcap_message(head, where);
    const auto channel = channels_.find(message.channel);
    if (channel == channels_.end()) {
      damage_.add(where + " is of channel " + std::to_string(message.channel) +
                  ", which the file does not describe before it; left out.");
      return;
    }
    add(topic(channel->second), message.log_time, place);
  }

  void add(std::size_t topic, std::uint64_t log_time, const McapMessagePlace& place) {
    if (index_.messages_.size() >= most_messages_) {
      throw DataError(file_.bytes().path().string() + ": has more than " +
                      grouped_text(most_messages_) +
                      " messages, which cannot be in so few bytes; the file is damaged.");
    }
    index_.messages_.add(topic, {mcap_time(log_time), place.number()});
  }

  /// Finds the messages of a chunk. @return where to go on
  std::uint64_t chunk(const McapPlace& record) {
    const std::uint64_t number = index_.chunks_.size();
    const McapChunkPlace place = file_.chunk(record);
    index_.chunks_.push_back(record.begin);
    if (trust_ && file_.is_whole(record)) {
      if (const auto end = use_indexes(record, place, number)) return *end;
    }
    unpack(place, number);
    if (!file_.is_whole(record)) throw_cut(record);
    return record.end();
  }

  void unpack(const McapChunkPlace& place, std::uint64_t number) {
    const Unpacked unpacked = file_.unpack(place);
    const std::string cut = for_each_record(unpacked.bytes, [&](const McapRecord& record) {
      if (record.op == McapOp::kSchema) {
        add_schema(read_mcap_schema(record.content, place.where));
      } else if (record.op == McapOp::kChannel) {
        add_channel(read_mcap_channel(record.content, place.where));
      } else if (record.op == McapOp::kMessage) {
        add_message(record.content, place.where, {number, record.begin});
      }
    });
    const std::string& problem = unpacked.problem.empty() ? cut : unpacked.problem;
    if (problem.empty()) return;
    damage_.add(place.where + ": " + problem + "; what stands before is read.");
  }

  /// Adds what the message indexes behind a chunk say, if these are just those that the summary
  /// names. @return where they end; nothing, with nothing added, if the chunk must be unpacked
  std::optional<std::uint64_t> use_indexes(const McapPlace& record, const McapChunkPlace& place,
                                           std::uint64_t number) {
    if (!summary_) return std::nullopt;
    const auto known = summary_->chunks.find(record.begin);
    if (known == summary_->chunks.end() || known->second.index_places.empty()) return std::nullopt;
    if (known->second.length != record.end() - record.begin) return std::nullopt;
    std::vector<McapMessageIndex> indexes;
    std::uint64_t at = record.end();
    const auto are_read = if_whole([&] {
      at = read_indexes(at, known->second, indexes);
      return true;
    });
    if (!are_read || !fits(indexes, place.head.unpacked_size)) return std::nullopt;
    for (const McapMessageIndex& index : indexes) {
      if (index.entries.empty()) continue;
      const std::size_t number_of_topic = topic(channels_.at(index.channel));
      for (const auto& [log_time, offset] : index.entries) {
        add(number_of_topic, log_time, {number, offset});
      }
    }
    used_indexes_ = true;
    return at;
  }

  /// @return where they end. @throws DataError if one is damaged or missing
  std::uint64_t read_indexes(std::uint64_t at, const McapChunkIndex& chunk,
                             std::vector<McapMessageIndex>& indexes) const {
    while (at < file_.bytes().size()) {
      const McapPlace record = file_.record(at);
      if (record.op != McapOp::kMessageIndex || !file_.is_whole(record)) break;
      indexes.push_back(read_mcap_message_index(file_.content(record), file_.where(record)));
      const auto named = chunk.index_places.find(indexes.back().channel);
      if (named == chunk.index_places.end() || named->second != at) {
        throw DataError(file_.where(record) + " is not known to the summary.");
      }
      at = record.end();
    }
    if (indexes.size() == chunk.index_places.size()) return at;
    throw DataError(file_.bytes().place(at) + ": a message index is missing.");
  }

  /// Whether the channels and types of all indexes are known, and all messages in the chunk.
  bool fits(const std::vector<McapMessageIndex>& indexes, std::uint64_t chunk_size) const {
    return std::all_of(indexes.begin(), indexes.end(), [&](const McapMessageIndex& index) {
      const auto channel = channels_.find(index.channel);
      if (channel == channels_.end()) return false;
      const std::uint16_t schema = channel->second.schema;
      if (schema != 0 && schemas_.find(schema) == schemas_.end()) return false;
      return std::all_of(index.entries.begin(), index.entries.end(), [&](const auto& entry) {
        return entry.offset < chunk_size && entry.offset < std::uint64_t{1} << kOffsetBits;
      });
    });
  }

  McapIndex& index_;
  const McapFile& file_;
  DamageNotes& damage_;
  const std::optional<McapSummary>& summary_;
  bool trust_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint64_t most_messages_ = 0;
  bool has_end_ = false, used_indexes_ = false;
};

McapIndex::McapIndex(const McapFile& file, DamageNotes& damage) {
  const std::optional<McapSummary> summary = read_mcap_summary(file);
  if (summary && Walk(*this, file, damage, summary, true).run()) return;
  messages_ = {};
  chunks_.clear();
  topics_.clear();
  Walk(*this, file, damage, summary, false).run();
}

std::optional<std::size_t> McapIndex::topic_of(std::uint16_t channel) const {
  const auto found = topics_.find(channel);
  return found == topics_.end() ? std::nullopt : std::optional(found->second);
}

namespace {

[[noreturn]] void throw_wrong_index(const std::string& where, std::uint64_t offset) {
  throw DataError(where + ": the index leads to byte " + grouped_text(offset) +
                  ", where the message that it tells of does not stand; the file is damaged. "
                  "`mcap recover` writes it anew.");
}

}  // namespace

McapBag::McapBag(const std::filesystem::path& path)
    : file_(path), index_(file_, damage_), checked_(index_.chunks().size(), false) {}

std::string McapBag::message(std::size_t topic, std::size_t index) const {
  return read(topic, index, std::numeric_limits<std::size_t>::max());
}

std::string McapBag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  return read(topic, index, most);
}

std::string McapBag::read(std::size_t topic, std::size_t index, std::size_t most) const {
  const MessageTable::Message& message = index_.messages().at(topic, index);
  const McapMessagePlace place = McapMessagePlace::of(message.place);
  if (place.chunk == McapMessagePlace::kNoChunk) {
    return in_file(file_.record(place.offset), topic, message, most);
  }
  const McapChunkPlace chunk = file_.chunk(file_.record(index_.chunks().at(place.chunk)));
  const bool is_plain = chunk.head.compression.empty();
  if (is_plain && is_checked(place.chunk)) {
    const McapPlace record = file_.record(chunk.packed + place.offset);
    if (record.end() <= chunk.packed + chunk.head.packed_size) {
      return in_file(record, topic, message, most);
    }
  }
  std::string whole = in_chunk(chunk, topic, message);
  if (whole.size() > most) whole.resize(most);
  return whole;
}

void McapBag::check_head(std::string_view content, std::size_t topic,
                         const MessageTable::Message& message, const std::string& where) const {
  const McapMessageHead head = read_mcap_message(content, where);
  if (index_.topic_of(head.channel) == topic && mcap_time(head.log_time) == message.recorded) {
    return;
  }
  throw_wrong_index(where, McapMessagePlace::of(message.place).offset);
}

std::string McapBag::in_file(const McapPlace& record, std::size_t topic,
                             const MessageTable::Message& message, std::size_t most) const {
  const std::string where = file_.where(record);
  if (record.op != McapOp::kMessage) {
    throw_wrong_index(where, McapMessagePlace::of(message.place).offset);
  }
  check_head(file_.beginning(record, kMcapMessageHeadSize), topic, message, where);
  std::string bytes = file_.content(record, kMcapMessageHeadSize, most);
  if (!is_cdr(topic) || !is_zstd(bytes)) return bytes;
  bytes = unpack_zstd_message(file_.content(record, kMcapMessageHeadSize), where);
  if (bytes.size() > most) bytes.resize(most);
  return bytes;
}

bool McapBag::is_checked(std::uint64_t chunk) const {
  const std::scoped_lock lock(checking_);
  return checked_.at(chunk);
}

ChunkStore::Chunk McapBag::unpacked(const McapChunkPlace& chunk, std::uint64_t number,
                                    std::string& problem) const {
  return chunks_.get(number, [&] {
    Unpacked all = file_.unpack(chunk, !is_checked(number));
    problem = std::move(all.problem);
    if (problem.empty()) {
      const std::scoped_lock lock(checking_);
      checked_.at(number) = true;
    }
    return std::move(all.bytes);
  });
}

std::string McapBag::in_chunk(const McapChunkPlace& chunk, std::size_t topic,
                              const MessageTable::Message& message) const {
  const McapMessagePlace place = McapMessagePlace::of(message.place);
  std::string problem;
  const ChunkStore::Chunk kept = unpacked(chunk, place.chunk, problem);
  const std::string_view bytes = *kept;
  if (place.offset + kMcapHeadSize <= bytes.size()) {
    McapFields head(bytes.substr(place.offset), chunk.where);
    const auto op = static_cast<McapOp>(head.u8());
    const std::uint64_t size = head.u64();
    const std::string_view rest = bytes.substr(place.offset + kMcapHeadSize);
    if (op != McapOp::kMessage) throw_wrong_index(chunk.where, place.offset);
    if (size <= rest.size()) {
      const std::string_view content = rest.substr(0, size);
      check_head(content, topic, message, chunk.where);
      return unpacked_if_packed(std::string(content.substr(kMcapMessageHeadSize)), is_cdr(topic),
                                chunk.where);
    }
  }
  throw DataError(chunk.where + ": " +
                  (problem.empty() ? "the message at byte " + grouped_text(place.offset) +
                                         " in it is not all there"
                                   : problem) +
                  "; the file is damaged. Copy it again.");
}

}  // namespace raymoval
