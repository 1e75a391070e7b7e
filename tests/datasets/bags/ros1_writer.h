// SPDX-License-Identifier: MIT
#pragma once

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "datasets/bags/ros1/ros1_file.h"

namespace raymoval::test {

/// Makes the bytes of a ROS 1 bag, with its index, as rosbag writes it.
class Ros1Writer {
 public:
  explicit Ros1Writer(Ros1Compression compression = Ros1Compression::kNone)
      : compression_(compression) {}

  void message(std::uint32_t id, const std::string& topic, const std::string& type,
               const std::string& md5, Nanoseconds time, const std::string& bytes) {
    if (!connections_.contains(id)) {
      const std::string data = field("topic", topic) + field("type", type) + field("md5sum", md5);
      connections_[id] =
          record(field("conn", number(id)) + op(Ros1Op::kConnection) + field("topic", topic), data);
      chunk_ += connections_[id];
    }
    entries_[id] += time_text(time) + number(static_cast<std::uint32_t>(chunk_.size()));
    chunk_ += record(
        field("conn", number(id)) + op(Ros1Op::kMessage) + field("time", time_text(time)), bytes);
  }

  void end_chunk() {
    if (chunk_.empty()) return;
    const std::string count = number(static_cast<std::uint32_t>(entries_.size()));
    infos_ += record(field("chunk_pos", number(bag_header(0).size() + body_.size())) +
                         field("count", count) + op(Ros1Op::kChunkInfo),
                     counts());
    ++chunks_;
    const char* compression =
        std::array{"none", "bz2", "lz4"}[static_cast<std::size_t>(compression_)];
    body_ += record(field("compression", compression) + op(Ros1Op::kChunk) +
                        field("size", number(static_cast<std::uint32_t>(chunk_.size()))),
                    packed());
    for (const auto& [id, entries] : entries_) {
      body_ += record(field("conn", number(id)) + field("count", count_of(entries)) +
                          op(Ros1Op::kIndexData) + field("ver", number(std::uint32_t{1})),
                      entries);
    }
    chunk_.clear();
    entries_.clear();
  }

  std::string finish() {
    end_chunk();
    std::string bag = bag_header(bag_header(0).size() + body_.size()) + body_;
    for (const auto& [id, connection] : connections_) bag += connection;
    return bag + infos_;
  }

 private:
  template <class Number>
  static std::string number(Number value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  static std::string time_text(Nanoseconds time) {
    return number(static_cast<std::uint32_t>(time / 1'000'000'000)) +
           number(static_cast<std::uint32_t>(time % 1'000'000'000));
  }
  static std::string field(std::string_view name, std::string_view value) {
    return number(static_cast<std::uint32_t>(name.size() + 1 + value.size())) + std::string(name) +
           "=" + std::string(value);
  }
  static std::string op(Ros1Op op) { return field("op", std::string(1, static_cast<char>(op))); }
  static std::string record(const std::string& fields, const std::string& data) {
    return number(static_cast<std::uint32_t>(fields.size())) + fields +
           number(static_cast<std::uint32_t>(data.size())) + data;
  }
  static std::string count_of(const std::string& entries) {
    return number(static_cast<std::uint32_t>(entries.size() / 12));
  }
  [[nodiscard]] std::string counts() const {
    std::string counts;
    for (const auto& [id, entries] : entries_) counts += number(id) + count_of(entries);
    return counts;
  }
  [[nodiscard]] std::string bag_header(std::uint64_t index_begin) const {
    const std::string fields =
        field("chunk_count", number(chunks_)) +
        field("conn_count", number(static_cast<std::uint32_t>(connections_.size()))) +
        field("index_pos", number(index_begin)) + op(Ros1Op::kBagHeader);
    return std::string(kRos1Magic) + record(fields, std::string(4096 - fields.size(), ' '));
  }
  [[nodiscard]] std::string packed() {
    if (compression_ == Ros1Compression::kNone) return chunk_;
    std::string bytes(chunk_.size() * 2 + 1000, '\0');
    if (compression_ == Ros1Compression::kLz4) {
      bytes.resize(
          LZ4F_compressFrame(bytes.data(), bytes.size(), chunk_.data(), chunk_.size(), nullptr));
      return bytes;
    }
    auto size = static_cast<unsigned>(bytes.size());
    BZ2_bzBuffToBuffCompress(bytes.data(), &size, chunk_.data(),
                             static_cast<unsigned>(chunk_.size()), 9, 0, 0);
    return bytes.substr(0, size);
  }

  Ros1Compression compression_;
  std::map<std::uint32_t, std::string> connections_;  ///< Their records.
  std::map<std::uint32_t, std::string> entries_;      ///< The index of the chunk at hand.
  std::string chunk_, body_, infos_;
  std::uint32_t chunks_ = 0;
};

}  // namespace raymoval::test
