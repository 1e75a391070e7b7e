// SPDX-License-Identifier: MIT
#include "datasets/bags/mcap/mcap_bag.h"

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

McapBag::McapBag(const std::filesystem::path& path) : file_(path), index_(file_, damage_) {}

std::string McapBag::message(std::size_t topic, std::size_t index) const {
  const MessageTable::Message& message = index_.messages().at(topic, index);
  const McapMessagePlace place = McapMessagePlace::of(message.place);
  return place.chunk == McapMessagePlace::kNoChunk ? in_file(topic, message)
                                                   : in_chunk(topic, message);
}

std::string McapBag::published(std::string_view content, std::size_t topic,
                               const MessageTable::Message& message,
                               const std::string& where) const {
  const McapMessageHead head = read_mcap_message(content, where);
  if (index_.topic_of(head.channel) != topic || mcap_time(head.log_time) != message.recorded) {
    throw_wrong_index(where, McapMessagePlace::of(message.place).offset);
  }
  return unpacked_if_packed(std::string(content.substr(kMcapMessageHeadSize)),
                            topics()[topic].encoding == MessageEncoding::kCdr, where);
}

std::string McapBag::in_file(std::size_t topic, const MessageTable::Message& message) const {
  const std::uint64_t offset = McapMessagePlace::of(message.place).offset;
  const McapPlace record = file_.record(offset);
  if (record.op != McapOp::kMessage) throw_wrong_index(file_.where(record), offset);
  return published(file_.content(record), topic, message, file_.where(record));
}

std::string McapBag::in_chunk(std::size_t topic, const MessageTable::Message& message) const {
  const McapMessagePlace place = McapMessagePlace::of(message.place);
  const McapChunkPlace chunk = file_.chunk(file_.record(index_.chunks().at(place.chunk)));
  std::string problem;
  const ChunkStore::Chunk unpacked = chunks_.get(place.chunk, [&] {
    Unpacked all = file_.unpack(chunk);
    problem = std::move(all.problem);
    return std::move(all.bytes);
  });
  const std::string_view bytes = *unpacked;
  if (place.offset + kMcapHeadSize <= bytes.size()) {
    McapFields head(bytes.substr(place.offset), chunk.where);
    const auto op = static_cast<McapOp>(head.u8());
    const std::uint64_t size = head.u64();
    const std::string_view rest = bytes.substr(place.offset + kMcapHeadSize);
    if (op != McapOp::kMessage) throw_wrong_index(chunk.where, place.offset);
    if (size <= rest.size()) return published(rest.substr(0, size), topic, message, chunk.where);
  }
  throw DataError(chunk.where + ": " +
                  (problem.empty() ? "the message at byte " + grouped_text(place.offset) +
                                         " in it is not all there"
                                   : problem) +
                  "; the file is damaged. Copy it again.");
}

}  // namespace raymoval
