// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

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
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

  [[nodiscard]] const McapFile& file() const { return file_; }
  [[nodiscard]] const McapIndex& index() const { return index_; }

 private:
  /// The first `most` bytes that were published, or all if there are fewer.
  [[nodiscard]] std::string read(std::size_t topic, std::size_t index, std::size_t most) const;
  /// The same of a message whose record stands in the file as it is.
  [[nodiscard]] std::string in_file(const McapPlace& record, std::size_t topic,
                                    const MessageTable::Message& message, std::size_t most) const;
  [[nodiscard]] std::string in_chunk(const McapChunkPlace& chunk, std::size_t topic,
                                     const MessageTable::Message& message) const;
  /// The chunk, unpacked; its checksum is looked at when it is asked for the first time.
  [[nodiscard]] ChunkStore::Chunk unpacked(const McapChunkPlace& chunk, std::uint64_t number,
                                           std::string& problem) const;
  [[nodiscard]] bool is_checked(std::uint64_t chunk) const;
  void check_head(std::string_view content, std::size_t topic, const MessageTable::Message& message,
                  const std::string& where) const;
  [[nodiscard]] bool is_cdr(std::size_t topic) const {
    return topics()[topic].encoding == MessageEncoding::kCdr;
  }

  McapFile file_;
  DamageNotes damage_;
  McapIndex index_;
  mutable ChunkStore chunks_;
  mutable std::mutex checking_;
  mutable std::vector<bool> checked_;  ///< Of each chunk, whether its checksum was found right.
};

}  // namespace raymoval
