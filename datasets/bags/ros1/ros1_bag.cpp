// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/ros1_bag.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// The bag's own record.
struct BagHeader {
  std::uint64_t index_begin = 0;
  std::uint32_t connections = 0, chunks = 0;
  std::uint64_t end = 0;  ///< Of the record: where the first chunk begins.
};

/// A chunk as the index at the end of the file tells of it.
struct ChunkInfo {
  std::uint64_t begin = 0;
  std::uint64_t messages = 0;
};

/// A message as the index behind its chunk tells of it.
struct IndexEntry {
  std::uint32_t connection = 0, offset = 0;
  Nanoseconds time = 0;
};

/// Bytes of an entry in an index record: a time and a place.
constexpr std::uint64_t kEntryBytes = 12;
/// Bytes of a connection and its count in the index at the end.
constexpr std::uint64_t kCountBytes = 8;
constexpr std::uint32_t kIndexVersion = 1;

/// Adds what is found to the contents, and says what could not be read.
class ContentsReader {
 public:
  ContentsReader(const BagFile& file, DamageNotes& notes)
      : file_(file), bytes_(file), notes_(notes) {}

  Ros1Contents read() {
    header_ = read_header();
    if (!read_from_index()) read_front_to_back();
    contents_.messages.finish();
    return std::move(contents_);
  }

 private:
  BagHeader read_header() const;
  bool read_from_index();
  std::vector<ChunkInfo> read_index(Ros1Contents& found) const;
  std::optional<std::vector<IndexEntry>> entries_of(const Ros1Chunk& chunk, const ChunkInfo& info,
                                                    std::uint64_t begin, std::uint64_t end) const;
  void read_entries(const Ros1Record& record, const Ros1Chunk& chunk, const std::string& where,
                    std::vector<IndexEntry>& entries) const;
  void read_indexed_chunk(const ChunkInfo& info, std::uint64_t end);

  void read_front_to_back();
  std::uint64_t read_next(std::uint64_t at);
  void walk_chunk(const Ros1Chunk& chunk);
  std::uint64_t walk_bytes(const Ros1Bytes& bytes, std::string& problem);
  void add_connection(const Ros1Connection& connection);
  bool add_message(std::uint32_t connection, Nanoseconds time, std::uint64_t place);

  /// Runs `read_chunk`; if the chunk is damaged, it is noted and left out.
  template <class ReadChunk>
  void read_or_note(ReadChunk&& read_chunk) {
    try {
      read_chunk();
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      notes_.add(std::string(error.what()) + " The rest of this chunk is left out.");
    }
  }
  [[noreturn]] void refuse(std::uint64_t at, const std::string& what) const {
    throw DataError(file_.place(at) + ": " + what);
  }

  const BagFile& file_;
  Ros1FileBytes bytes_;
  DamageNotes& notes_;
  BagHeader header_;
  Ros1Contents contents_;
};

BagHeader ContentsReader::read_header() const {
  if (file_.read_up_to(0, kRos1Magic.size()) != kRos1Magic) {
    refuse(0,
           "is no ROS 1 bag of version 2.0, which begins with \"#ROSBAG V2.0\". An older one "
           "becomes one with: rosbag fix.");
  }
  const std::uint64_t begin = kRos1Magic.size();
  const Ros1Record record = read_record(bytes_, begin);
  const std::string where = file_.place(begin);
  if (op_of(record, where) != Ros1Op::kBagHeader) refuse(begin, "expected the bag's own header.");
  if (!find_field(record.header, "encryptor", where).value_or("").empty()) {
    refuse(begin, "the bag is encrypted, which is not read. Decrypt it with: rosbag decrypt.");
  }
  return {u64_field(record.header, "index_pos", where),
          u32_field(record.header, "conn_count", where),
          u32_field(record.header, "chunk_count", where), record.end()};
}

void ContentsReader::add_connection(const Ros1Connection& connection) {
  const auto [known, is_new] = contents_.connections.emplace(connection.id, connection);
  if (is_new) {
    contents_.topics[connection.id] = contents_.messages.topic(
        connection.topic, connection.type, MessageEncoding::kRos1, connection.md5);
  } else if (known->second.topic != connection.topic || known->second.type != connection.type) {
    notes_.add(file_.path().filename().string() + ": connection " + std::to_string(connection.id) +
               " is said to be of " + known->second.topic + " and of " + connection.topic +
               "; the first is taken.");
  }
}

bool ContentsReader::add_message(std::uint32_t connection, Nanoseconds time, std::uint64_t place) {
  const auto topic = contents_.topics.find(connection);
  if (topic == contents_.topics.end()) return false;
  contents_.messages.add(topic->second, {time, place});
  return true;
}

// --- From the index ---

std::vector<ChunkInfo> ContentsReader::read_index(Ros1Contents& found) const {
  std::vector<ChunkInfo> infos;
  for (std::uint64_t at = header_.index_begin; at < file_.size();) {
    const Ros1Record record = read_record(bytes_, at);
    const std::string where = file_.place(at);
    check_data_is_there(bytes_, record);
    const Ros1Op op = op_of(record, where);
    if (op == Ros1Op::kConnection) {
      Ros1Connection connection = read_connection(bytes_, record, where);
      found.connections.emplace(connection.id, std::move(connection));
    } else if (op == Ros1Op::kChunkInfo) {
      const std::uint64_t count = u32_field(record.header, "count", where);
      if (record.data_size != count * kCountBytes || count > header_.connections) {
        refuse(at, "the counts of a chunk do not fit.");
      }
      ChunkInfo info{u64_field(record.header, "chunk_pos", where), 0};
      const std::string counts = bytes_.read(record.data_begin, record.data_size);
      for (std::uint64_t i = 0; i < count; ++i) {
        info.messages += little_endian<std::uint32_t>(counts, i * kCountBytes + 4);
      }
      infos.push_back(info);
    } else {
      refuse(at, "neither a connection nor a chunk in the index.");
    }
    at = record.end();
  }
  return infos;
}

/// Takes the messages of all chunks from the index. @return false, with nothing taken, if it is not
/// there whole
bool ContentsReader::read_from_index() {
  const std::string name = file_.path().filename().string();
  const auto give_up = [&](const std::string& why) {
    notes_.add(name + ": " + why + " It is read from front to back; `rosbag reindex` mends it.");
    return false;
  };
  if (header_.index_begin == 0) return give_up("the bag was never closed and has no index.");
  if (header_.index_begin > file_.size()) {
    return give_up("the file ends at byte " + grouped_text(file_.size()) +
                   ", before its index, which should begin at byte " +
                   grouped_text(header_.index_begin) + ": it is cut.");
  }
  Ros1Contents found;
  std::vector<ChunkInfo> infos;
  try {
    infos = read_index(found);
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError& error) {
    return give_up(std::string("the index is cut or damaged (") + error.what() + ").");
  }
  if (infos.size() != header_.chunks || found.connections.size() != header_.connections) {
    return give_up("the index tells of " + counted_text(infos.size(), "chunk") + " and " +
                   counted_text(found.connections.size(), "connection") + ", the header of " +
                   grouped_text(header_.chunks) + " and " + grouped_text(header_.connections) +
                   ": it is cut.");
  }
  std::sort(infos.begin(), infos.end(),
            [](const ChunkInfo& a, const ChunkInfo& b) { return a.begin < b.begin; });
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const std::uint64_t end = i + 1 < infos.size() ? infos[i + 1].begin : header_.index_begin;
    if (infos[i].begin < header_.end || infos[i].begin >= end) {
      return give_up("the index places a chunk at byte " + grouped_text(infos[i].begin) +
                     ", where none can be.");
    }
  }
  for (const auto& [id, connection] : found.connections) add_connection(connection);
  for (std::size_t i = 0; i < infos.size(); ++i) {
    read_indexed_chunk(infos[i], i + 1 < infos.size() ? infos[i + 1].begin : header_.index_begin);
  }
  return true;
}

/// Chunks do not overlap, so all of them together take a time that grows with the file.
/// @param end where the next chunk or the index begins
void ContentsReader::read_indexed_chunk(const ChunkInfo& info, std::uint64_t end) {
  read_or_note([&] {
    const Ros1Record record = read_record(bytes_, info.begin);
    const std::string where = file_.place(info.begin);
    if (op_of(record, where) != Ros1Op::kChunk || record.end() > end) {
      refuse(info.begin, "the index places a chunk there, but there is none.");
    }
    const Ros1Chunk chunk = read_chunk(bytes_, record, info.begin);
    const auto entries = entries_of(chunk, info, record.end(), end);
    if (!entries) {
      walk_chunk(chunk);
      return;
    }
    contents_.chunks.push_back(chunk);
    for (const IndexEntry& entry : *entries) {
      add_message(entry.connection, entry.time,
                  message_place(contents_.chunks.size() - 1, entry.offset));
    }
  });
}

/// The messages of a chunk by the index records behind it. Nothing if these do not fit the chunk.
std::optional<std::vector<IndexEntry>> ContentsReader::entries_of(const Ros1Chunk& chunk,
                                                                  const ChunkInfo& info,
                                                                  std::uint64_t begin,
                                                                  std::uint64_t end) const {
  return if_whole([&] {
    std::vector<IndexEntry> entries;
    for (std::uint64_t at = begin; at < end;) {
      const Ros1Record record = read_record(bytes_, at);
      const std::string where = file_.place(at);
      if (op_of(record, where) != Ros1Op::kIndexData) break;
      if (record.end() > end) refuse(at, "an index reaches beyond its chunk.");
      read_entries(record, chunk, where, entries);
      at = record.end();
    }
    if (entries.size() != info.messages) refuse(begin, "the index of a chunk lacks messages.");
    return entries;
  });
}

void ContentsReader::read_entries(const Ros1Record& record, const Ros1Chunk& chunk,
                                  const std::string& where,
                                  std::vector<IndexEntry>& entries) const {
  const std::uint64_t count = u32_field(record.header, "count", where);
  const std::uint32_t connection = u32_field(record.header, "conn", where);
  // No message takes less than a byte of its chunk, which bounds what is read here.
  if (u32_field(record.header, "ver", where) != kIndexVersion ||
      record.data_size != count * kEntryBytes || count > chunk.size ||
      !contents_.topics.contains(connection)) {
    throw DataError(where + ": an index that does not fit its chunk.");
  }
  const std::string data = bytes_.read(record.data_begin, record.data_size);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto offset = little_endian<std::uint32_t>(data, i * kEntryBytes + 8);
    if (offset >= chunk.size) throw DataError(where + ": a message behind the end of its chunk.");
    entries.push_back({connection, offset, ros1_time(data, i * kEntryBytes)});
  }
}

// --- From front to back ---

void ContentsReader::read_front_to_back() {
  contents_ = {};
  for (std::uint64_t at = header_.end; at < file_.size();) {
    try {
      at = read_next(at);
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      notes_.add(std::string(error.what()) + " What follows is left out.");
      break;
    }
  }
  if (header_.chunks > contents_.chunks.size()) {
    notes_.add(file_.path().filename().string() + ": " + grouped_text(contents_.chunks.size()) +
               " of its " + counted_text(header_.chunks, "chunk") + " are there.");
  }
}

/// @return where the next record begins
std::uint64_t ContentsReader::read_next(std::uint64_t at) {
  const Ros1Record record = read_record(bytes_, at);
  const std::string where = file_.place(at);
  const Ros1Op op = op_of(record, where);
  if (op == Ros1Op::kChunk) {
    read_or_note([&] { walk_chunk(read_chunk(bytes_, record, at)); });
    return std::min(record.end(), file_.size());
  }
  check_data_is_there(bytes_, record);
  if (op == Ros1Op::kConnection) add_connection(read_connection(bytes_, record, where));
  if (op == Ros1Op::kMessage) {
    notes_.add(where +
               ": a message outside of a chunk, which no bag of version 2.0 has; such "
               "messages are left out.");
  }
  return record.end();
}

/// Takes the messages of a chunk from the chunk itself.
void ContentsReader::walk_chunk(const Ros1Chunk& chunk) {
  const std::string where = file_.place(chunk.begin) + ": a chunk";
  std::string problem;
  std::uint64_t count = 0;
  if (chunk.compression == Ros1Compression::kNone) {
    contents_.chunks.push_back(chunk);
    count = walk_bytes(Ros1PlainChunkBytes(file_, chunk), problem);
  } else {
    const Unpacked unpacked = unpack_chunk(file_, chunk);
    contents_.chunks.push_back(chunk);
    count = walk_bytes(Ros1ChunkBytes(unpacked.bytes, where), problem);
    if (!unpacked.problem.empty()) problem = unpacked.problem;
  }
  if (problem.empty() && !chunk.cut) return;
  notes_.add(where + " is " + (chunk.cut ? "cut" : "damaged") +
             (problem.empty() ? "" : " (" + problem + ")") + "; " + counted_text(count, "message") +
             " of it can be read.");
}

/// @param bytes of the last chunk
/// @param problem gets what is wrong where reading ended
/// @return how many messages it has
std::uint64_t ContentsReader::walk_bytes(const Ros1Bytes& bytes, std::string& problem) {
  Ros1ChunkWalk walk(bytes);
  std::uint64_t count = 0;
  while (const auto found = walk.next()) {
    const std::string where = bytes.place(found->begin);
    if (found->op == Ros1Op::kConnection) {
      const auto connection =
          if_whole([&] { return read_connection(bytes, found->record, where); });
      if (connection) add_connection(*connection);
      continue;
    }
    // A small file that unpacks to very many small messages would fill the memory.
    if (contents_.messages.size() > file_.size()) {
      throw DataError(where + ": the bag unpacks to more messages than it has bytes.");
    }
    const std::uint64_t place = message_place(contents_.chunks.size() - 1, found->begin);
    if (add_message(found->connection, found->time, place)) {
      ++count;
    } else {
      notes_.add(where + ": a message of connection " + std::to_string(found->connection) +
                 ", of which nothing is known, is left out.");
    }
  }
  problem = walk.problem();
  return count;
}

}  // namespace

Ros1Contents read_contents(const BagFile& file, DamageNotes& notes) {
  return ContentsReader(file, notes).read();
}

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

}  // namespace raymoval
