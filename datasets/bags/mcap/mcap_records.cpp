// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_records.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

void put_number(std::string& bytes, std::uint64_t number, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
}

}  // namespace

std::string_view McapFields::take(std::uint64_t count) {
  const std::size_t left = content_.size() - at_;
  if (count > left) {
    throw DataError(where_ + ": a field of " + grouped_text(count) + " bytes should follow, but " +
                    counted_text(left, "byte") + " of the record are left; the file is damaged. " +
                    "Copy it again.");
  }
  const std::string_view taken = content_.substr(at_, static_cast<std::size_t>(count));
  at_ += taken.size();
  return taken;
}

std::uint64_t McapFields::number(std::size_t size) {
  const std::string_view bytes = take(size);
  std::uint64_t number = 0;
  for (std::size_t i = size; i > 0; --i) {
    number = number << 8U | static_cast<unsigned char>(bytes[i - 1]);
  }
  return number;
}

McapSchema read_mcap_schema(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapSchema schema;
  schema.id = fields.u16();
  schema.name = fields.text();
  return schema;
}

McapChannel read_mcap_channel(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapChannel channel;
  channel.id = fields.u16();
  channel.schema = fields.u16();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  return channel;
}

McapMessageHead read_mcap_message(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapMessageHead message;
  message.channel = fields.u16();
  fields.u32();  // The publisher's count.
  message.log_time = fields.u64();
  fields.u64();  // When it was published.
  return message;
}

McapChunkHead read_mcap_chunk(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapChunkHead chunk;
  fields.u64();  // The first and the last time in it.
  fields.u64();
  chunk.unpacked_size = fields.u64();
  chunk.crc = fields.u32();
  chunk.compression = fields.text();
  chunk.packed_size = fields.u64();
  chunk.packed_at = fields.at();
  return chunk;
}

McapMessageIndex read_mcap_message_index(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapMessageIndex index;
  index.channel = fields.u16();
  McapFields entries(fields.text(), where);
  while (!entries.empty()) {
    McapMessageIndex::Entry entry;
    entry.log_time = entries.u64();
    entry.offset = entries.u64();
    index.entries.push_back(entry);
  }
  return index;
}

McapChunkIndex read_mcap_chunk_index(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapChunkIndex index;
  fields.u64();  // The first and the last time in it.
  fields.u64();
  index.start = fields.u64();
  index.length = fields.u64();
  McapFields places(fields.text(), where);
  while (!places.empty()) {
    const std::uint16_t channel = places.u16();
    index.index_places[channel] = places.u64();
  }
  return index;
}

McapFooter read_mcap_footer(std::string_view content, const std::string& where) {
  McapFields fields(content, where);
  McapFooter footer;
  footer.summary_start = fields.u64();
  footer.offsets_start = fields.u64();
  footer.crc = fields.u32();
  return footer;
}

void put_u16(std::string& bytes, std::uint16_t number) {
  put_number(bytes, number, 2);
}

void put_u32(std::string& bytes, std::uint32_t number) {
  put_number(bytes, number, 4);
}

void put_u64(std::string& bytes, std::uint64_t number) {
  put_number(bytes, number, 8);
}

void put_text(std::string& bytes, std::string_view text) {
  put_u32(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

void put_record(std::string& bytes, McapOp op, std::string_view content) {
  bytes += static_cast<char>(op);
  put_u64(bytes, content.size());
  bytes += content;
}

std::string for_each_record(std::string_view records,
                            const std::function<void(const McapRecord&)>& call) {
  for (std::size_t at = 0; at < records.size();) {
    const std::string_view rest = records.substr(at);
    const std::string place = "byte " + grouped_text(at) + " in it";
    if (rest.size() < kMcapHeadSize) return place + " begins a record that is cut";
    McapFields head(rest, "");
    const auto op = static_cast<McapOp>(head.u8());
    const std::uint64_t size = head.u64();
    if (op == McapOp::kInvalid) return place + " begins a record of type 0, which does not exist";
    if (size > rest.size() - kMcapHeadSize) return place + " begins a record that is cut";
    const auto length = static_cast<std::size_t>(size);
    call({op, at, rest.substr(kMcapHeadSize, length)});
    at += kMcapHeadSize + length;
  }
  return {};
}

}  // namespace raymoval
