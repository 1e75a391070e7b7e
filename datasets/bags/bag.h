// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// How the messages of a topic are serialised.
enum class MessageEncoding {
  kRos1,   ///< ROS 1: little-endian, no padding.
  kCdr,    ///< ROS 2: a head of four bytes, then CDR of either byte order.
  kOther,  ///< Anything else; such messages are passed on, never read.
};

/// A topic of a bag. Messages of different publishers belong to one topic if its name, type and
/// encoding are equal.
struct BagTopic {
  std::string name;  ///< "/velodyne_points".
  std::string type;  ///< In the form of ROS 1: "sensor_msgs/PointCloud2", without "/msg/".
  MessageEncoding encoding = MessageEncoding::kOther;
  std::uint64_t messages = 0;  ///< Number of readable messages.
};

/// A recording of messages. Memory holds only an index of a few tens of bytes per message; a
/// message is read when it is requested. All calls are thread-safe.
class Bag {
 public:
  virtual ~Bag() = default;
  [[nodiscard]] virtual const std::filesystem::path& path() const = 0;
  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// When message `index` of topic `topic` was recorded. Messages of a topic are numbered in the
  /// order of these times; messages of one time are in the order of the file.
  [[nodiscard]] virtual Nanoseconds recorded(std::size_t topic, std::size_t index) const = 0;
  /// The bytes of that message as published, decompressed.
  /// @throws DataError naming the file, the byte and what is wrong there; UnreadableError if the
  ///   disk fails
  [[nodiscard]] virtual std::string message(std::size_t topic, std::size_t index) const = 0;
  /// The first `most` bytes of that message, or all if it has fewer: enough for its header. Where
  /// the format allows it, the rest is not read.
  /// @throws as `message`
  [[nodiscard]] virtual std::string message_head(std::size_t topic, std::size_t index,
                                                 std::size_t most) const {
    std::string bytes = message(topic, index);
    if (bytes.size() > most) bytes.resize(most);
    return bytes;
  }
  /// Sentences on unreadable parts of the file, such as a truncated end; none if it is whole. Their
  /// number is bounded.
  [[nodiscard]] virtual std::vector<std::string> damage() const = 0;
};

/// Whether `path` looks like a recording: .bag, .mcap or .db3, each perhaps with .zst, or a folder
/// with metadata.yaml. @throws UnreadableError if it cannot be accessed
bool is_bag(const std::filesystem::path& path);

/// @throws DataError if the file is damaged or holds no message; UsageError for a known format that
///   is not supported, with the remedy
std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

}  // namespace raymoval
