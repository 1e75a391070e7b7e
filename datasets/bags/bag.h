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

/// How the messages of a topic are made into bytes.
enum class MessageEncoding {
  kRos1,   ///< ROS 1: little-endian, no padding.
  kCdr,    ///< ROS 2: a head of four bytes, then CDR of either byte order.
  kOther,  ///< Anything else; such messages are passed on, never read.
};

/// A kind of message in a bag, and how many there are. Topics of one name with different types or
/// from different publishers are one topic if name, type and encoding agree, and several otherwise.
struct BagTopic {
  std::string name;  ///< "/velodyne_points".
  std::string type;  ///< As ROS 1 writes it in both: "sensor_msgs/PointCloud2", without "/msg/".
  MessageEncoding encoding = MessageEncoding::kOther;
  std::uint64_t messages = 0;  ///< Those that can be read.
};

/// A recording of messages. Only an index of a few tens of bytes a message is in memory; messages
/// are read when they are asked for. All calls are thread-safe.
class Bag {
 public:
  virtual ~Bag() = default;
  [[nodiscard]] virtual const std::filesystem::path& path() const = 0;
  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// When message `index` of topic `topic` was recorded. Messages of a topic are numbered in the
  /// order of these times, and where they are equal in that of the file.
  [[nodiscard]] virtual Nanoseconds recorded(std::size_t topic, std::size_t index) const = 0;
  /// The bytes of that message as they were published, unpacked.
  /// @throws DataError naming the file, the byte and what is wrong there; UnreadableError if the
  ///   disk fails
  [[nodiscard]] virtual std::string message(std::size_t topic, std::size_t index) const = 0;
  /// The first `most` bytes of that message, or all if it has fewer, for those who want to know no
  /// more than its header. Formats that can give them without reading all of it do so.
  /// @throws as `message`
  [[nodiscard]] virtual std::string message_head(std::size_t topic, std::size_t index,
                                                 std::size_t most) const {
    std::string bytes = message(topic, index);
    if (bytes.size() > most) bytes.resize(most);
    return bytes;
  }
  /// Sentences on what of the file could not be read, such as a cut end; none if it is whole. They
  /// are bounded in number, however often a file is damaged.
  [[nodiscard]] virtual std::vector<std::string> damage() const = 0;
};

/// Whether `path` looks like a recording: .bag, .mcap, .db3 or one of these with .zst, or a folder
/// with metadata.yaml. @throws UnreadableError if it cannot be looked at
bool is_bag(const std::filesystem::path& path);

/// @throws DataError saying what is wrong with the file, or that it holds no message; UsageError
/// for
///   a form of recording that is known and not read, with the remedy
std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

}  // namespace raymoval
