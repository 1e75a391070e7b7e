// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/ros1_bag.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace raymoval {

Ros1Bag::Ros1Bag(const std::filesystem::path& path)
    : file_(path), contents_(read_contents(file_, notes_)) {}

/// Calls `call` with the bytes of a chunk, unpacked. A chunk that is not packed is not read whole.
template <class Call>
auto Ros1Bag::with_chunk(std::size_t number, Call&& call) const {
  const Ros1Chunk& chunk = contents_.chunks[number];
  if (chunk.compression == Ros1Compression::kNone) return call(Ros1PlainChunkBytes(file_, chunk));
  const ChunkStore::Chunk bytes = unpacked_.get(number, [&] {
    Unpacked unpacked = unpack_chunk(file_, chunk);
    if (!unpacked.problem.empty()) {
      notes_.add(file_.place(chunk.begin) + ": a chunk is " + (chunk.cut ? "cut" : "damaged") +
                 " (" + unpacked.problem + ").");
    }
    return std::move(unpacked.bytes);
  });
  return call(Ros1ChunkBytes(*bytes, file_.place(chunk.begin) + ": a chunk"));
}

std::string Ros1Bag::read_message(std::size_t topic, std::size_t index, std::size_t most) const {
  const MessageTable::Message& wanted = contents_.messages.at(topic, index);
  return with_chunk(chunk_of(wanted.place), [&](const Ros1Bytes& bytes) {
    Ros1ChunkWalk walk(bytes);
    walk.jump(offset_of(wanted.place));
    std::optional<Ros1ChunkRecord> found;
    // Some writers point to the connection that stands before a message.
    do found = walk.next();
    while (found && found->op == Ros1Op::kConnection);
    const std::string where = bytes.place(offset_of(wanted.place));
    if (!found) {
      throw DataError(walk.problem().empty()
                          ? where + ": a message should begin there, but the chunk has " +
                                std::to_string(bytes.size()) + " bytes; it is damaged."
                          : walk.problem());
    }
    const auto of_topic = contents_.topics.find(found->connection);
    if (of_topic == contents_.topics.end() || of_topic->second != topic) {
      throw DataError(where + ": the index places a message of " + topics()[topic].name +
                      " there, but it is of another topic; the index is damaged. `rosbag reindex` "
                      "mends it.");
    }
    return bytes.read(found->record.data_begin,
                      std::min<std::uint64_t>(most, found->record.data_size));
  });
}

std::string Ros1Bag::message(std::size_t topic, std::size_t index) const {
  return read_message(topic, index, std::numeric_limits<std::size_t>::max());
}

std::string Ros1Bag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  return read_message(topic, index, most);
}

void Ros1Bag::for_each_message(std::size_t number,
                               const std::function<void(const StoredMessage&)>& call) const {
  with_chunk(number, [&](const Ros1Bytes& bytes) {
    Ros1ChunkWalk walk(bytes);
    while (const auto found = walk.next()) {
      const auto topic = contents_.topics.find(found->connection);
      if (found->op != Ros1Op::kMessage || topic == contents_.topics.end()) continue;
      call({found->connection, topic->second, found->time,
            bytes.read(found->record.data_begin, found->record.data_size)});
    }
    if (!walk.problem().empty()) notes_.add(walk.problem() + " What follows is left out.");
  });
}

}  // namespace raymoval
