// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "datasets/bags/bag.h"
#include "datasets/bags/chunks/bag_file.h"
#include "datasets/bags/chunks/chunk_store.h"
#include "datasets/bags/damage_notes.h"
#include "datasets/bags/ros1/contents.h"

namespace raymoval {

/// A ROS 1 bag of version 2.0, not packed or packed by bz2 or lz4. Its index is used where it is
/// whole; a bag that was cut or never closed is read from front to back when it is opened. 16 bytes
/// a message are in memory, and the chunks that were unpacked last.
class Ros1Bag : public Bag {
 public:
  /// @throws DataError as `read_contents`; UnreadableError if the disk fails
  explicit Ros1Bag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override {
    return contents_.messages.topics();
  }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return contents_.messages.at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return notes_.sentences(); }

  /// A message as it stands in its chunk.
  struct StoredMessage {
    std::uint32_t connection = 0;
    std::size_t topic = 0;
    Nanoseconds recorded = 0;
    std::string bytes;
  };
  [[nodiscard]] const std::map<std::uint32_t, Ros1Connection>& connections() const {
    return contents_.connections;
  }
  [[nodiscard]] const std::vector<Ros1Chunk>& chunks() const { return contents_.chunks; }
  /// Calls `call` for each message of chunk `number` in the order of the file; what it throws goes
  /// through. Of a damaged chunk, those before the damage. @throws UnreadableError
  void for_each_message(std::size_t number,
                        const std::function<void(const StoredMessage&)>& call) const;

 private:
  template <class Call>
  auto with_chunk(std::size_t number, Call&& call) const;
  std::string read_message(std::size_t topic, std::size_t index, std::size_t most) const;

  BagFile file_;
  mutable DamageNotes notes_;
  mutable ChunkStore unpacked_;
  Ros1Contents contents_;
};

}  // namespace raymoval
