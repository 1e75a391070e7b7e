// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/files/file_kind.h"
#include "datasets/bags/chunks/pack.h"
#include "datasets/bags/chunks/zstandard.h"
#include "datasets/bags/mcap/mcap_writer.h"
#include "datasets/bags/rewriting/rewrite_file.h"

namespace raymoval {
namespace {

/// Goes through a file from front to back and writes what it finds. Errors of reading are told by
/// the bag already; what is behind them is looked for as the bag does.
class McapRewriting {
 public:
  McapRewriting(const McapBag& bag, FileWriter& output, const ChangeMessage& change)
      : bag_(bag), file_(bag.file()), change_(change), writer_(output) {}

  void run() {
    for (std::uint64_t at = kMcapMagic.size(); at != 0 && at < file_.bytes().size();) {
      at = step(at);
    }
    writer_.finish();
  }

 private:
  std::uint64_t step(std::uint64_t at) {
    const auto record = if_whole([&] { return file_.record(at); });
    if (!record) return next_chunk_behind(at);
    if (record->op == McapOp::kDataEnd || record->op == McapOp::kFooter) return 0;
    const bool is_whole = file_.is_whole(*record);
    if (record->op == McapOp::kChunk) {
      chunk(*record);
    } else if (is_whole && record->op != McapOp::kMessageIndex) {
      const auto content = if_whole([&] { return file_.content(*record); });
      if (content) copy(record->op, *content, {McapMessagePlace::kNoChunk, at});
    }
    return is_whole ? record->end() : next_chunk_behind(at);
  }

  std::uint64_t next_chunk_behind(std::uint64_t at) const {
    const auto& chunks = bag_.index().chunks();
    const auto next = std::upper_bound(chunks.begin(), chunks.end(), at);
    return next == chunks.end() ? 0 : *next;
  }

  void chunk(const McapPlace& record) {
    const auto& chunks = bag_.index().chunks();
    const auto known = std::lower_bound(chunks.begin(), chunks.end(), record.begin);
    if (known == chunks.end() || *known != record.begin) return;
    const auto place = if_whole([&] { return file_.chunk(record); });
    if (!place) return;
    const auto unpacked = if_whole([&] { return file_.unpack(*place); });
    if (!unpacked) return;
    writer_.begin_chunk(place->head.compression);
    const auto number = static_cast<std::uint64_t>(known - chunks.begin());
    for_each_record(unpacked->bytes, [&](const McapRecord& inside) {
      copy(inside.op, inside.content, {number, inside.begin});
    });
    // A chunk in which nothing changed is copied as it is packed.
    const bool is_same = unpacked->problem.empty() && writer_.chunk() == unpacked->bytes;
    writer_.end_chunk(is_same ? file_.bytes().read(place->packed, place->head.packed_size) : "");
  }

  void copy(McapOp op, std::string_view content, const McapMessagePlace& place) {
    if (op != McapOp::kMessage) {
      const bool fits = is_readable(op, content);
      if (fits) writer_.record(op, content);
      return;
    }
    const auto head = if_whole([&] { return read_mcap_message(content, "a message"); });
    const auto topic = head ? bag_.index().topic_of(head->channel) : std::nullopt;
    if (!topic) return;
    const auto index =
        bag_.index().messages().index_of(*topic, {mcap_time(head->log_time), place.number()});
    if (!index) return;
    const std::string stored(content.substr(kMcapMessageHeadSize));
    const bool is_cdr = bag_.topics()[*topic].encoding == MessageEncoding::kCdr;
    const auto message =
        if_whole([&] { return unpacked_if_packed(stored, is_cdr, file_.bytes().path().string()); });
    if (!message) return;
    auto changed = change_(*topic, *index, *message);
    if (!changed) return;
    if (*changed == *message) {
      writer_.record(op, content);
      return;
    }
    if (is_cdr && is_zstd(stored)) changed = pack_zstd(*changed);
    writer_.record(op, std::string(content.substr(0, kMcapMessageHeadSize)) + *changed);
  }

  /// Whether the writer can make an index of a record.
  static bool is_readable(McapOp op, std::string_view content) {
    return if_whole([&] {
             if (op == McapOp::kAttachment) {
               McapFields fields(content, "an attachment");
               fields.u64();
               fields.u64();
               fields.text();
               fields.text();
               fields.u64();
             } else if (op == McapOp::kMetadata) {
               McapFields(content, "metadata").text();
             } else if (op == McapOp::kSchema || op == McapOp::kChannel) {
               McapFields(content, "a schema or channel").u16();
             }
             return true;
           }) == true;
  }

  const McapBag& bag_;
  const McapFile& file_;
  const ChangeMessage& change_;
  McapWriter writer_;
};

}  // namespace

void rewrite_mcap(const McapBag& bag, FileWriter& output, const ChangeMessage& change) {
  McapRewriting(bag, output, change).run();
}

}  // namespace raymoval
