// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/ros1_writer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/bags/chunks/pack.h"

namespace raymoval {
namespace {

constexpr std::uint32_t kVersion = 1;
constexpr Nanoseconds kSecond = 1'000'000'000;

template <class Number>
std::string little(Number number) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof number; ++i) {
    bytes.push_back(static_cast<char>((number >> (8 * i)) & 0xFFU));
  }
  return bytes;
}

std::string time_bytes(Nanoseconds time) {
  return little(static_cast<std::uint32_t>(time / kSecond)) +
         little(static_cast<std::uint32_t>(time % kSecond));
}

std::string field(std::string_view name, std::string_view value) {
  return little(static_cast<std::uint32_t>(name.size() + 1 + value.size())) + std::string(name) +
         "=" + std::string(value);
}

std::string op_field(Ros1Op op) {
  return field("op", std::string(1, static_cast<char>(op)));
}

/// The header of a record and the length of its data, which follows.
std::string record_head(const std::string& fields, std::size_t data_size) {
  return little(static_cast<std::uint32_t>(fields.size())) + fields +
         little(static_cast<std::uint32_t>(data_size));
}

std::string connection_record(const Ros1Connection& connection) {
  return record_head(field("conn", little(connection.id)) + op_field(Ros1Op::kConnection) +
                         field("topic", connection.topic),
                     connection.fields.size()) +
         connection.fields;
}

std::string packed(const std::string& bytes, Ros1Compression compression) {
  if (compression == Ros1Compression::kBz2) return pack_bz2(bytes);
  if (compression == Ros1Compression::kLz4) return pack_lz4(bytes);
  return bytes;
}

}  // namespace

Ros1Writer::Ros1Writer(FileWriter& file) : file_(file) {
  append(kRos1Magic);
  append(bag_header(0));
}

void Ros1Writer::append(std::string_view bytes) {
  file_.append(bytes);
  size_ += bytes.size();
}

std::string Ros1Writer::bag_header(std::uint64_t index_begin) const {
  const std::string fields =
      field("chunk_count", little(static_cast<std::uint32_t>(infos_.size()))) +
      field("conn_count", little(static_cast<std::uint32_t>(connections_.size()))) +
      field("index_pos", little(index_begin)) + op_field(Ros1Op::kBagHeader);
  const std::size_t room = kBagHeaderRoom - fields.size();
  return record_head(fields, room) + std::string(room, ' ');
}

void Ros1Writer::begin_chunk(Ros1Compression compression) {
  compression_ = compression;
  chunk_.clear();
  entries_.clear();
}

void Ros1Writer::message(const Ros1Connection& connection, Nanoseconds time,
                         std::string_view bytes) {
  const auto refuse = [&](const std::string& what) {
    throw DataError(file_.path().string() + ": a message of " + connection.topic + " " + what);
  };
  if (time < 0 || time / kSecond > std::numeric_limits<std::uint32_t>::max()) {
    refuse("was recorded at " + stamp_text(time) + " s, which a ROS 1 bag cannot hold.");
  }
  if (connections_.emplace(connection.id, connection).second) {
    chunk_ += connection_record(connection);
  }
  const std::string head =
      record_head(field("conn", little(connection.id)) + op_field(Ros1Op::kMessage) +
                      field("time", time_bytes(time)),
                  bytes.size());
  if (chunk_.size() + head.size() + bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    refuse("makes its chunk larger than 4 GiB, which a ROS 1 bag cannot hold.");
  }
  entries_[connection.id].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  chunk_.append(head).append(bytes);
}

void Ros1Writer::end_chunk() {
  if (chunk_.empty()) return;
  ChunkInfo info{size_, std::numeric_limits<Nanoseconds>::max(), 0, {}};
  const std::string data = packed(chunk_, compression_);
  append(record_head(field("compression", ros1_compression_name(compression_)) +
                         op_field(Ros1Op::kChunk) +
                         field("size", little(static_cast<std::uint32_t>(chunk_.size()))),
                     data.size()));
  append(data);
  write_chunk_index(info);
  infos_.push_back(std::move(info));
  begin_chunk(compression_);
}

void Ros1Writer::write_chunk_index(ChunkInfo& info) {
  for (auto& [connection, entries] : entries_) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time < b.time; });
    const auto count = static_cast<std::uint32_t>(entries.size());
    std::string data;
    for (const Entry& entry : entries) data += time_bytes(entry.time) + little(entry.offset);
    append(record_head(field("conn", little(connection)) + field("count", little(count)) +
                           op_field(Ros1Op::kIndexData) + field("ver", little(kVersion)),
                       data.size()));
    append(data);
    info.first = std::min(info.first, entries.front().time);
    info.last = std::max(info.last, entries.back().time);
    info.counts.emplace_back(connection, count);
  }
}

void Ros1Writer::finish() {
  end_chunk();
  const std::uint64_t index_begin = size_;
  for (const auto& [id, connection] : connections_) append(connection_record(connection));
  for (const ChunkInfo& info : infos_) {
    std::string data;
    for (const auto& [connection, count] : info.counts) data += little(connection) + little(count);
    append(record_head(field("chunk_pos", little(info.begin)) +
                           field("count", little(static_cast<std::uint32_t>(info.counts.size()))) +
                           field("end_time", time_bytes(info.last)) + op_field(Ros1Op::kChunkInfo) +
                           field("start_time", time_bytes(info.first)) +
                           field("ver", little(kVersion)),
                       data.size()));
    append(data);
  }
  file_.overwrite(kRos1Magic.size(), bag_header(index_begin));
}

}  // namespace raymoval
