// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_bag.h"

#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "datasets/bags/chunks/zstandard.h"

namespace raymoval {
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
