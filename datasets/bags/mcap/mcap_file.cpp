// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_file.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {

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

std::string for_each_record(std::string_view records,
                            const std::function<void(const McapRecord&)>& call) {
  for (std::size_t at = 0; at < records.size();) {
    const std::string_view rest = records.substr(at);
    const std::string place = "byte " + grouped_text(at) + " in it";
    if (rest.size() < kMcapHeadSize) return place + " begins a truncated record";
    McapFields head(rest, "");
    const auto op = static_cast<McapOp>(head.u8());
    const std::uint64_t size = head.u64();
    if (op == McapOp::kInvalid) return place + " begins a record of type 0, which does not exist";
    if (size > rest.size() - kMcapHeadSize) return place + " begins a truncated record";
    const auto length = static_cast<std::size_t>(size);
    call({op, at, rest.substr(kMcapHeadSize, length)});
    at += kMcapHeadSize + length;
  }
  return {};
}

namespace {

constexpr std::uint64_t kMostContent = std::uint64_t{1} << 30;
/// Bytes of a chunk's head with the longest compression name that is read.
constexpr std::uint64_t kChunkHeadSize = 8 + 8 + 8 + 4 + 4 + 64 + 8;

[[noreturn]] void throw_too_large(const std::string& where, std::uint64_t size) {
  throw DataError(where + " of " + grouped_text(size) +
                  " bytes; at most 1 GiB is expected, so the file looks damaged. Copy it again.");
}

Decompressed decompress_by(const std::string& compression, std::string packed, std::uint64_t stated,
                           const std::string& where) {
  if (compression == "zstd") return decompress_zstd(packed, stated, where);
  if (compression == "lz4") return decompress_lz4(packed, stated, where);
  std::string problem;
  if (packed.size() != stated) {
    problem = "it has " + grouped_text(packed.size()) + " of the " + grouped_text(stated) +
              " bytes that it should have";
  }
  return {std::move(packed), problem};
}

/// The name of an op.
std::string_view mcap_op_name(McapOp op) {
  static constexpr std::array<std::string_view, 16> kNames = {
      "record of type 0", "header",     "footer",        "schema",         "channel",
      "message",          "chunk",      "message index", "chunk index",    "attachment",
      "attachment index", "statistics", "metadata",      "metadata index", "summary offset",
      "end of data"};
  const auto number = static_cast<std::size_t>(op);
  return number < kNames.size() ? kNames[number] : "record of an unknown type";
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& path) : bytes_(path) {
  if (bytes_.read_up_to(0, kMcapMagic.size()) == kMcapMagic) return;
  throw DataError(path.string() +
                  ": does not begin as a MCAP file (89 4D 43 41 50 30 0D 0A); it is damaged or "
                  "something else. Copy it again.");
}

std::string McapFile::where(const McapPlace& record) const {
  return bytes_.place(record.begin) + ": " + std::string(mcap_op_name(record.op));
}

McapPlace McapFile::record(std::uint64_t offset) const {
  const std::string head = bytes_.read(offset, kMcapHeadSize);
  McapFields fields(head, bytes_.place(offset));
  McapPlace record;
  record.op = static_cast<McapOp>(fields.u8());
  record.begin = offset;
  record.size = fields.u64();
  if (record.op != McapOp::kInvalid) return record;
  throw DataError(bytes_.place(offset) +
                  ": a record of type 0 begins here, which does not exist; the file is damaged. "
                  "Copy it again.");
}

bool McapFile::is_whole(const McapPlace& record) const {
  return record.content() <= bytes_.size() && record.size <= bytes_.size() - record.content();
}

std::string McapFile::content(const McapPlace& record, std::uint64_t skip,
                              std::uint64_t most) const {
  if (record.size <= kMostContent) {
    return bytes_.read(record.content() + skip, std::min(record.size - skip, most));
  }
  throw_too_large(where(record), record.size);
}

std::string McapFile::beginning(const McapPlace& record, std::uint64_t most) const {
  return bytes_.read_up_to(record.content(), std::min(record.size, most));
}

McapChunkPlace McapFile::chunk(const McapPlace& record) const {
  McapChunkPlace chunk;
  chunk.where = where(record);
  chunk.head = read_mcap_chunk(beginning(record, kChunkHeadSize), chunk.where);
  const std::string& compression = chunk.head.compression;
  if (!compression.empty() && compression != "lz4" && compression != "zstd") {
    throw DataError(chunk.where + " is compressed by '" + compression +
                    "'; expected lz4, zstd or nothing. Write the file again by `mcap compress "
                    "--compression zstd`.");
  }
  if (chunk.head.packed_size > record.size - chunk.head.packed_at) {
    throw DataError(chunk.where + " should hold " + grouped_text(chunk.head.packed_size) +
                    " bytes of records, more than it has; the file is damaged. Copy it again.");
  }
  chunk.packed = record.content() + chunk.head.packed_at;
  return chunk;
}

Decompressed McapFile::unpack(const McapChunkPlace& chunk) const {
  const McapChunkHead& head = chunk.head;
  if (head.packed_size > kMostContent) throw_too_large(chunk.where, head.packed_size);
  std::string packed = bytes_.read_up_to(chunk.packed, head.packed_size);
  const bool is_truncated = packed.size() < head.packed_size;
  check_decompressed_size(head.packed_size, head.unpacked_size, chunk.where);
  // The limit is for the bytes that are there: missing bytes cannot be decompressed.
  const std::uint64_t most = std::min(head.unpacked_size, most_decompressed_size(packed.size()));
  Decompressed unpacked = decompress_by(head.compression, std::move(packed), most, chunk.where);
  if (is_truncated) unpacked.problem = "the file ends in the middle of it";
  if (unpacked.problem.empty() && head.crc != 0 && crc32_of(unpacked.bytes) != head.crc) {
    return {"", "its bytes do not have the checksum that is stored with it"};
  }
  return unpacked;
}

}  // namespace raymoval
