// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "datasets/bags/bag.h"

namespace raymoval {

/// Calls `read`. @return the message of the DataError that `read` throws; empty if it throws none
/// @throws UnreadableError, which is no damage, and all other errors of `read`
template <class Read>
std::string damage_in(Read&& read) {
  try {
    read();
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError& error) {
    return error.what();
  }
  return {};
}

/// Sentences on unreadable parts of a recording. The first few are kept and the rest are counted,
/// so that a file with damage everywhere fills no memory. All calls are thread-safe.
class DamageNotes {
 public:
  /// How many sentences are kept.
  static constexpr std::size_t kMost = 8;

  /// @param sentence the problem, with the file and the byte. Duplicates are left out.
  void add(std::string sentence);
  /// The sentences in the order in which they came, and one with the number of those left out.
  [[nodiscard]] std::vector<std::string> sentences() const;
  [[nodiscard]] bool empty() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> kept_;
  std::size_t more_ = 0;
};

/// The index of a recording: the time and the place of each message of each topic. It takes 16
/// bytes per message.
class MessageTable {
 public:
  struct Message {
    Nanoseconds recorded = 0;
    std::uint64_t place = 0;  ///< Its meaning depends on the format; it increases along the file.
    auto operator<=>(const Message&) const = default;
  };

  /// The number of the topic with this name, type and encoding; adds the topic if it is new.
  /// @param key distinguishes further topics, such as the checksum of a type
  std::size_t topic(const std::string& name, const std::string& type, MessageEncoding encoding,
                    const std::string& key = {});
  void add(std::size_t topic, const Message& message);
  /// Number of messages added.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Sorts the messages of each topic by time, then by place.
  void finish();

  [[nodiscard]] const std::vector<BagTopic>& topics() const { return topics_; }
  /// @throws InternalError if there is no such message
  [[nodiscard]] const Message& at(std::size_t topic, std::size_t index) const;

 private:
  using Key = std::tuple<std::string, std::string, MessageEncoding, std::string>;
  std::vector<BagTopic> topics_;
  std::map<Key, std::size_t> numbers_;
  std::vector<std::deque<Message>> messages_;  ///< A deque never has twice its size at once.
  std::uint64_t size_ = 0;
};

/// A recording with an index that is filled when it is opened.
class IndexedBag : public Bag {
 public:
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return table_.topics(); }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return table_.at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override {
    return message_head(topic, index, std::numeric_limits<std::size_t>::max());
  }
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

 protected:
  mutable DamageNotes damage_;
  MessageTable table_;
};

/// "sensor_msgs/PointCloud2" of "sensor_msgs/msg/PointCloud2"; other names are unchanged.
std::string ros1_type_name(const std::string& type);

}  // namespace raymoval
