// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_writer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "datasets/bags/chunks/checksum.h"
#include "datasets/bags/chunks/pack.h"

namespace raymoval {
namespace {

std::string packed_by(const std::string& compression, const std::string& records) {
  if (compression == "zstd") return pack_zstd(records);
  if (compression == "lz4") return pack_lz4(records);
  return records;
}

std::string attachment_index(std::string_view content, std::uint64_t begin, std::uint64_t length) {
  McapFields fields(content, "an attachment");
  std::string index;
  put_u64(index, begin);
  put_u64(index, length);
  put_u64(index, fields.u64());  // When it was logged.
  put_u64(index, fields.u64());  // When it was made.
  const std::string_view name = fields.text(), media_type = fields.text();
  put_u64(index, fields.u64());
  put_text(index, name);
  put_text(index, media_type);
  return index;
}

std::string metadata_index(std::string_view content, std::uint64_t begin, std::uint64_t length) {
  std::string index;
  put_u64(index, begin);
  put_u64(index, length);
  put_text(index, McapFields(content, "metadata").text());
  return index;
}

}  // namespace

McapWriter::McapWriter(FileWriter& file) : file_(file) {
  append(kMcapMagic);
}

void McapWriter::append(std::string_view bytes) {
  file_.append(bytes);
  size_ += bytes.size();
}

void McapWriter::record(McapOp op, std::string_view content) {
  note(op, content, kMcapHeadSize + content.size());
  if (in_chunk_) {
    put_record(chunk_, op, content);
    return;
  }
  std::string bytes;
  put_record(bytes, op, content);
  append(bytes);
}

void McapWriter::note(McapOp op, std::string_view content, std::uint64_t length) {
  if (op == McapOp::kSchema) {
    schemas_.emplace(McapFields(content, "a schema").u16(), content);
  } else if (op == McapOp::kChannel) {
    channels_.emplace(McapFields(content, "a channel").u16(), content);
  } else if (op == McapOp::kMessage) {
    note_message(content);
  } else if (op == McapOp::kAttachment) {
    ++attachments_;
    put_record(attachment_indexes_, McapOp::kAttachmentIndex,
               attachment_index(content, size_, length));
  } else if (op == McapOp::kMetadata) {
    ++metadata_;
    put_record(metadata_indexes_, McapOp::kMetadataIndex, metadata_index(content, size_, length));
  }
}

void McapWriter::note_message(std::string_view content) {
  const McapMessageHead message = read_mcap_message(content, "a message");
  first_ = messages_ == 0 ? message.log_time : std::min(first_, message.log_time);
  last_ = std::max(last_, message.log_time);
  ++messages_;
  ++counts_[message.channel];
  if (in_chunk_) entries_[message.channel].push_back({message.log_time, chunk_.size()});
}

void McapWriter::begin_chunk(std::string compression) {
  in_chunk_ = true;
  compression_ = std::move(compression);
  chunk_.clear();
  entries_.clear();
}

void McapWriter::end_chunk(std::string packed) {
  in_chunk_ = false;
  if (chunk_.empty()) return;
  if (packed.empty()) packed = packed_by(compression_, chunk_);
  ChunkInfo info;
  info.start = size_;
  info.packed = packed.size();
  info.unpacked = chunk_.size();
  info.compression = compression_;
  bool is_first = true;
  for (const auto& [channel, entries] : entries_) {
    for (const McapMessageIndex::Entry& entry : entries) {
      info.first = is_first ? entry.log_time : std::min(info.first, entry.log_time);
      info.last = std::max(info.last, entry.log_time);
      is_first = false;
    }
  }
  std::string head;
  put_u64(head, info.first);
  put_u64(head, info.last);
  put_u64(head, info.unpacked);
  put_u32(head, crc32_of(chunk_));
  put_text(head, compression_);
  put_u64(head, packed.size());
  std::string begin(1, static_cast<char>(McapOp::kChunk));
  put_u64(begin, head.size() + packed.size());
  append(begin + head);
  append(packed);
  info.length = size_ - info.start;
  write_indexes(info);
  chunks_.push_back(std::move(info));
  chunk_.clear();
}

void McapWriter::write_indexes(ChunkInfo& info) {
  const std::uint64_t begin = size_;
  for (const auto& [channel, entries] : entries_) {
    std::string places, content, record;
    for (const McapMessageIndex::Entry& entry : entries) {
      put_u64(places, entry.log_time);
      put_u64(places, entry.offset);
    }
    put_u16(content, channel);
    put_text(content, places);
    put_record(record, McapOp::kMessageIndex, content);
    info.index_places[channel] = size_;
    append(record);
  }
  info.index_length = size_ - begin;
}

std::string McapWriter::statistics() const {
  std::string content, counts, record;
  put_u64(content, messages_);
  put_u16(content, static_cast<std::uint16_t>(schemas_.size()));
  put_u32(content, static_cast<std::uint32_t>(channels_.size()));
  put_u32(content, attachments_);
  put_u32(content, metadata_);
  put_u32(content, static_cast<std::uint32_t>(chunks_.size()));
  put_u64(content, first_);
  put_u64(content, last_);
  for (const auto& [channel, count] : counts_) {
    put_u16(counts, channel);
    put_u64(counts, count);
  }
  put_text(content, counts);
  put_record(record, McapOp::kStatistics, content);
  return record;
}

std::string McapWriter::chunk_indexes() const {
  std::string records;
  for (const ChunkInfo& chunk : chunks_) {
    std::string content, places;
    for (const auto& [channel, place] : chunk.index_places) {
      put_u16(places, channel);
      put_u64(places, place);
    }
    for (const std::uint64_t number : {chunk.first, chunk.last, chunk.start, chunk.length}) {
      put_u64(content, number);
    }
    put_text(content, places);
    put_u64(content, chunk.index_length);
    put_text(content, chunk.compression);
    put_u64(content, chunk.packed);
    put_u64(content, chunk.unpacked);
    put_record(records, McapOp::kChunkIndex, content);
  }
  return records;
}

void McapWriter::finish() {
  std::string end;
  put_record(end, McapOp::kDataEnd, std::string(4, '\0'));  // Without a checksum.
  append(end);

  const std::uint64_t summary_start = size_;
  std::array<Group, 6> groups{{{McapOp::kSchema, {}},
                               {McapOp::kChannel, {}},
                               {McapOp::kStatistics, statistics()},
                               {McapOp::kChunkIndex, chunk_indexes()},
                               {McapOp::kAttachmentIndex, attachment_indexes_},
                               {McapOp::kMetadataIndex, metadata_indexes_}}};
  for (const auto& [id, content] : schemas_) {
    put_record(groups[0].records, McapOp::kSchema, content);
  }
  for (const auto& [id, content] : channels_) {
    put_record(groups[1].records, McapOp::kChannel, content);
  }
  std::string summary, offsets;
  for (const Group& group : groups) {
    if (group.records.empty()) continue;
    std::string content(1, static_cast<char>(group.op));
    put_u64(content, summary_start + summary.size());
    put_u64(content, group.records.size());
    put_record(offsets, McapOp::kSummaryOffset, content);
    summary += group.records;
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary += offsets;
  // The checksum is of all that stands before it in the summary and the footer.
  summary += static_cast<char>(McapOp::kFooter);
  put_u64(summary, 20);
  put_u64(summary, summary_start);
  put_u64(summary, offsets_start);
  put_u32(summary, crc32_of(summary));
  append(summary);
  append(kMcapMagic);
}

}  // namespace raymoval
