// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "datasets/bags/bag.h"
#include "datasets/bags/chunks/chunk_store.h"
#include "datasets/bags/mcap/mcap_index.h"

namespace raymoval {

/// A recording in a MCAP file.
class McapBag : public Bag {
 public:
  /// @throws DataError if it is no MCAP file; UnreadableError
  explicit McapBag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.bytes().path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override {
    return index_.messages().topics();
  }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return index_.messages().at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

  [[nodiscard]] const McapFile& file() const { return file_; }
  [[nodiscard]] const McapIndex& index() const { return index_; }

 private:
  [[nodiscard]] std::string in_file(std::size_t topic, const MessageTable::Message& message) const;
  [[nodiscard]] std::string in_chunk(std::size_t topic, const MessageTable::Message& message) const;
  /// What was published, of the content of a message's record.
  [[nodiscard]] std::string published(std::string_view content, std::size_t topic,
                                      const MessageTable::Message& message,
                                      const std::string& where) const;

  McapFile file_;
  DamageNotes damage_;
  McapIndex index_;
  mutable ChunkStore chunks_;
};

}  // namespace raymoval
