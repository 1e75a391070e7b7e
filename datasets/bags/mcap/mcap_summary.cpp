// SPDX-License-Identifier: MIT
#include "core/files/file_kind.h"
#include "datasets/bags/chunks/checksum.h"
#include "datasets/bags/mcap/mcap_index.h"

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
  summary.begin = footer.summary_start;
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

}  // namespace raymoval
