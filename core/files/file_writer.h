// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/files/descriptor.h"

namespace raymoval {

/// Writes a file piece by piece so that its path either keeps what it held or, from `commit` on,
/// holds all of it. Until then the pieces stand in a temporary file beside it (see `new_part_name`)
/// that goes with the writer. Every member throws DataError naming the path and the system's reason
/// (disk full, no rights).
class FileWriter {
 public:
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void append(std::string_view content);
  /// Replaces bytes that were appended, from `offset` on.
  void overwrite(std::uint64_t offset, std::string_view content);
  /// Puts all of it on the disk: what can fail for lack of space has failed after this.
  void sync();
  /// Gives the file its name.
  void commit();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail() const;
  void put(std::string_view content, std::uint64_t offset);

  std::filesystem::path path_, temporary_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  bool synced_ = false, committed_ = false;
};

/// Puts the names in `folder` on the disk, where its file system can do that.
void sync_folder(const std::filesystem::path& folder);

}  // namespace raymoval
