// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/bag_file.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/decompress.h"
#include "datasets/bags/ros1/ros1_file.h"

namespace raymoval {
namespace {

/// Bytes of an entry in an index record: a time and a place.
constexpr std::uint64_t kEntryBytes = 12;
/// Bytes of a connection and its count in the index at the end.
constexpr std::uint64_t kCountBytes = 8;
constexpr std::uint32_t kIndexVersion = 1;

/// The contents of a ROS 1 bag, without its messages.
struct Ros1Contents {
  std::map<std::uint32_t, std::size_t> topics;  ///< Topic of each connection.
  std::vector<Ros1Chunk> chunks;                ///< In the order of the file.
};

/// A message's chunk and its byte there in one number, which increases along the file. A chunk
/// decompresses to less than 4 GiB because its size has 32 bits.
constexpr std::uint64_t message_place(std::size_t chunk, std::uint64_t offset) {
  return (static_cast<std::uint64_t>(chunk) << 32U) | offset;
}
constexpr std::size_t chunk_of(std::uint64_t place) {
  return static_cast<std::size_t>(place >> 32U);
}
constexpr std::uint64_t offset_of(std::uint64_t place) {
  return place & 0xFFFFFFFFU;
}

/// Reads the contents of a bag. If its index is whole and fits the chunks, it is used. Else the
/// chunks are read from front to back up to the end of the file. Unreadable parts become sentences
/// in `notes`.
class Ros1Reader {
 public:
  Ros1Reader(const BagFile& file, DamageNotes& notes)
      : file_(file), name_(file.path().filename().string()), bytes_(file), notes_(notes) {}

  /// @param messages gets them; places are those of `message_place`
  Ros1Contents read(MessageTable& messages) {
    read_header();
    const std::string problem = index_problem();
    if (!problem.empty()) {
      notes_.add(name_ + ": " + problem +
                 " It is read from front to back; `rosbag reindex` repairs it.");
      contents_ = {};
      table_ = {};
      read_front_to_back();
    }
    table_.finish();
    messages = std::move(table_);
    return std::move(contents_);
  }

 private:
  void read_header() {
    if (file_.read_up_to(0, kRos1Magic.size()) != kRos1Magic) {
      refuse(0,
             "is no ROS 1 bag of version 2.0, which begins with \"#ROSBAG V2.0\". An older one "
             "becomes one with: rosbag fix.");
    }
    const std::uint64_t begin = kRos1Magic.size();
    const Ros1Record record = read_record(bytes_, begin);
    if (record.op() != Ros1Op::kBagHeader) refuse(begin, "expected the bag's own header.");
    if (!record.find("encryptor").value_or("").empty()) {
      refuse(begin, "the bag is encrypted, which is not read. Decrypt it with: rosbag decrypt.");
    }
    index_begin_ = record.u64("index_pos");
    connections_ = record.u32("conn_count");
    chunks_ = record.u32("chunk_count");
    header_end_ = record.end();
  }

  void add_connection(const Ros1Connection& connection) {
    const auto [known, is_new] = contents_.topics.try_emplace(connection.id, 0);
    if (is_new) {
      known->second =
          table_.topic(connection.topic, connection.type, MessageEncoding::kRos1, connection.md5);
      return;
    }
    const BagTopic& topic = table_.topics()[known->second];
    if (topic.name == connection.topic && topic.type == connection.type) return;
    notes_.add(name_ + ": connection " + std::to_string(connection.id) + " is both of " +
               topic.name + " and of " + connection.topic + "; the first is used.");
  }

  /// Takes all messages from the index. @return why the index cannot be used; empty if it can
  std::string index_problem() {
    if (index_begin_ == 0) return "the bag was never closed and has no index.";
    if (index_begin_ > file_.size()) {
      return "the file ends at byte " + grouped_text(file_.size()) +
             ", before its index, which should begin at byte " + grouped_text(index_begin_) +
             ": it is truncated.";
    }
    const std::string damage = damage_in([&] { read_index(); });
    return damage.empty() ? "" : "the index is truncated or damaged (" + damage + ").";
  }

  void read_index() {
    for (std::uint64_t at = index_begin_; at < file_.size();) {
      const Ros1Record record = read_record(bytes_, at);
      check_data_is_there(bytes_, record);
      const Ros1Op op = record.op();
      if (op == Ros1Op::kConnection) {
        add_connection(read_connection(bytes_, record));
      } else if (op == Ros1Op::kChunkInfo) {
        const std::uint64_t count = record.u32("count");
        if (record.data_size != count * kCountBytes || count > connections_) {
          refuse(at, "the counts of a chunk do not fit.");
        }
        std::uint64_t& messages = places_[record.u64("chunk_pos")];
        const std::string counts = bytes_.read(record.data_begin, record.data_size);
        for (std::uint64_t i = 0; i < count; ++i) {
          messages += little_endian<std::uint32_t>(counts, i * kCountBytes + 4);
        }
      } else {
        refuse(at, "the index has a record that is neither a connection nor a chunk.");
      }
      at = record.end();
    }
    if (places_.size() != chunks_ || contents_.topics.size() != connections_) {
      refuse(index_begin_, "the index lists " + counted_text(places_.size(), "chunk") + " and " +
                               counted_text(contents_.topics.size(), "connection") +
                               ", the header of " + grouped_text(chunks_) + " and " +
                               grouped_text(connections_) + ".");
    }
    for (auto place = places_.begin(); place != places_.end(); ++place) {
      const auto next = std::next(place);
      read_indexed_chunk(place->first, place->second,
                         next == places_.end() ? index_begin_ : next->first);
    }
  }

  /// Chunks do not overlap, so the time is linear in the size of the file.
  /// @param end where the next chunk or the index begins
  void read_indexed_chunk(std::uint64_t begin, std::uint64_t messages, std::uint64_t end) {
    const Ros1Record record = read_record(bytes_, begin);
    if (record.op() != Ros1Op::kChunk || record.end() > end) {
      refuse(begin, "the index places a chunk there, but there is none.");
    }
    contents_.chunks.push_back(read_chunk(bytes_, record));
    std::uint64_t found = 0;
    for (std::uint64_t at = record.end(); at < end;) {
      const Ros1Record index = read_record(bytes_, at);
      if (index.op() != Ros1Op::kIndexData) break;
      if (index.end() > end) refuse(at, "an index reaches beyond its chunk.");
      found += read_entries(index);
      at = index.end();
    }
    if (found != messages) refuse(begin, "the index of a chunk lacks messages.");
  }

  /// Adds the messages of the last chunk that an index record behind it names.
  std::uint64_t read_entries(const Ros1Record& record) {
    const Ros1Chunk& chunk = contents_.chunks.back();
    const std::uint64_t count = record.u32("count");
    const auto topic = contents_.topics.find(record.u32("conn"));
    // No message takes less than a byte of its chunk, which bounds what is read here.
    if (record.u32("ver") != kIndexVersion || record.data_size != count * kEntryBytes ||
        count > chunk.size || topic == contents_.topics.end()) {
      throw DataError(record.where + ": an index that does not fit its chunk.");
    }
    const std::string data = bytes_.read(record.data_begin, record.data_size);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto offset = little_endian<std::uint32_t>(data, i * kEntryBytes + 8);
      if (offset >= chunk.size) {
        throw DataError(record.where + ": a message behind the end of its chunk.");
      }
      table_.add(topic->second, {ros1_time(data, i * kEntryBytes),
                                 message_place(contents_.chunks.size() - 1, offset)});
    }
    return count;
  }

  /// Behind damage, reading continues at the next chunk of the index.
  void read_front_to_back() {
    for (std::uint64_t at = header_end_; at < file_.size();) {
      const std::string damage = damage_in([&] { at = read_next(at); });
      if (damage.empty()) continue;
      const auto next = places_.upper_bound(at);
      notes_.add(damage + (next == places_.end()
                               ? " What follows is left out."
                               : " What follows up to the next chunk is left out."));
      at = next == places_.end() ? file_.size() : next->first;
    }
    if (chunks_ > contents_.chunks.size()) {
      notes_.add(name_ + ": " + grouped_text(contents_.chunks.size()) + " of its " +
                 counted_text(chunks_, "chunk") + " are there.");
    }
  }

  /// @return where the next record begins
  std::uint64_t read_next(std::uint64_t at) {
    const Ros1Record record = read_record(bytes_, at);
    const Ros1Op op = record.op();
    if (op == Ros1Op::kChunk) {
      const std::string damage = damage_in([&] { walk_chunk(read_chunk(bytes_, record)); });
      if (!damage.empty()) notes_.add(damage + " The rest of this chunk is left out.");
      return std::min(record.end(), file_.size());
    }
    check_data_is_there(bytes_, record);
    if (op == Ros1Op::kConnection) add_connection(read_connection(bytes_, record));
    if (op == Ros1Op::kMessage) {
      notes_.add(record.where +
                 ": a message outside of a chunk, which no bag of version 2.0 has; such "
                 "messages are left out.");
    }
    return record.end();
  }

  /// Takes the messages of a chunk from the chunk itself.
  void walk_chunk(const Ros1Chunk& chunk) {
    const std::string where = file_.place(chunk.begin) + ": a chunk";
    const bool is_compressed = chunk.compression != Ros1Compression::kNone;
    const Decompressed unpacked = is_compressed ? decompress_chunk(file_, chunk) : Decompressed{};
    contents_.chunks.push_back(chunk);
    std::string problem;
    const std::uint64_t count =
        walk_bytes(is_compressed ? Ros1Bytes(unpacked.bytes, where)
                                 : Ros1Bytes(file_, chunk.data_begin, chunk.packed),
                   problem);
    if (!unpacked.problem.empty()) problem = unpacked.problem;
    if (problem.empty() && !chunk.cut) return;
    notes_.add(where + " is " + (chunk.cut ? "truncated" : "damaged") +
               (problem.empty() ? "" : " (" + problem + ")") + "; " +
               counted_text(count, "message") + " of it can be read.");
  }

  /// @param bytes of the last chunk
  /// @param problem gets the problem at which reading ended
  /// @return number of messages
  std::uint64_t walk_bytes(const Ros1Bytes& bytes, std::string& problem) {
    std::uint64_t count = 0, at = 0;
    std::optional<Ros1Record> found;
    while ((problem = damage_in([&] { found = next_in_chunk(bytes, at); })).empty() && found) {
      if (found->op() == Ros1Op::kConnection) {
        const auto connection = if_whole([&] { return read_connection(bytes, *found); });
        if (connection) add_connection(*connection);
        continue;
      }
      // A small file that decompresses to very many small messages would fill the memory.
      if (table_.size() > file_.size()) {
        throw DataError(found->where +
                        ": the bag decompresses to more messages than it has bytes.");
      }
      const std::uint32_t connection = found->u32("conn");
      const auto topic = contents_.topics.find(connection);
      if (topic == contents_.topics.end()) {
        notes_.add(found->where + ": a message of connection " + std::to_string(connection) +
                   ", which the bag does not describe, is left out.");
        continue;
      }
      table_.add(topic->second,
                 {found->time("time"), message_place(contents_.chunks.size() - 1, found->begin)});
      ++count;
    }
    return count;
  }

  [[noreturn]] void refuse(std::uint64_t at, const std::string& what) const {
    throw DataError(file_.place(at) + ": " + what);
  }

  const BagFile& file_;
  std::string name_;
  Ros1Bytes bytes_;
  DamageNotes& notes_;
  std::uint64_t index_begin_ = 0, header_end_ = 0;
  std::uint32_t connections_ = 0, chunks_ = 0;     ///< Of the bag's header record.
  std::map<std::uint64_t, std::uint64_t> places_;  ///< Where chunks begin, and their messages.
  Ros1Contents contents_;
  MessageTable table_;
};

/// A ROS 1 bag of version 2.0, not compressed or compressed by bz2 or lz4. A whole index is used; a
/// bag that was truncated or never closed is read from front to back when it is opened. Memory
/// holds 16 bytes per message and the chunks that were decompressed last.
class Ros1Bag : public IndexedBag {
 public:
  explicit Ros1Bag(const std::filesystem::path& path)
      : file_(path), contents_(Ros1Reader(file_, damage_).read(table_)) {}

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;

 private:
  std::string read_from(const Ros1Bytes& chunk, std::uint64_t offset, std::size_t topic,
                        std::size_t most) const;

  BagFile file_;
  mutable ChunkStore unpacked_;
  Ros1Contents contents_;
};

std::string Ros1Bag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  const std::uint64_t place = table_.at(topic, index).place;
  const Ros1Chunk& chunk = contents_.chunks[chunk_of(place)];
  if (chunk.compression == Ros1Compression::kNone) {
    return read_from(Ros1Bytes(file_, chunk.data_begin, chunk.packed), offset_of(place), topic,
                     most);
  }
  const std::string where = file_.place(chunk.begin) + ": a chunk";
  const ChunkStore::Chunk unpacked = unpacked_.get(chunk_of(place), [&] {
    Decompressed all = decompress_chunk(file_, chunk);
    if (!all.problem.empty()) {
      damage_.add(where + " is " + (chunk.cut ? "truncated" : "damaged") + " (" + all.problem +
                  ").");
    }
    return std::move(all.bytes);
  });
  return read_from(Ros1Bytes(*unpacked, where), offset_of(place), topic, most);
}

std::string Ros1Bag::read_from(const Ros1Bytes& chunk, std::uint64_t offset, std::size_t topic,
                               std::size_t most) const {
  const std::string where = chunk.place(offset);
  // Some writers point to the connection before a message.
  auto found = next_in_chunk(chunk, offset);
  while (found && found->op() == Ros1Op::kConnection) found = next_in_chunk(chunk, offset);
  if (!found) {
    throw DataError(where + ": a message should begin there, but the chunk has " +
                    std::to_string(chunk.size()) + " bytes; it is damaged.");
  }
  const auto of_topic = contents_.topics.find(found->u32("conn"));
  if (of_topic == contents_.topics.end() || of_topic->second != topic) {
    throw DataError(
        where + ": the index places a message of " + topics()[topic].name +
        " there, but it is of another topic; the index is damaged. `rosbag reindex` repairs it.");
  }
  return chunk.read(found->data_begin, std::min<std::uint64_t>(most, found->data_size));
}

}  // namespace

std::unique_ptr<Bag> open_ros1(const std::filesystem::path& path) {
  return std::make_unique<Ros1Bag>(path);
}

}  // namespace raymoval
