// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "core/files/descriptor.h"
#include "core/files/part_name.h"

namespace raymoval {

class Replacements;

/// Writes a file piece by piece so that its path either keeps what it held or, from `commit` on,
/// holds all of it. Until then the pieces stand in a temporary file beside it (see `new_part_file`)
/// that goes with the writer. A file that is replaced keeps its rights, and its owner where the
/// system allows that; a link is replaced, and what it leads to stays (see `output_target`).
/// Every member throws DataError naming the path and the system's reason (disk full, no rights).
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
  /// Puts all of it on the disk and lets `together` give it its name.
  void commit_with(Replacements& together);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail() const;
  void put(std::string_view content, std::uint64_t offset);

  std::filesystem::path path_;
  Part part_;  ///< Locked until it has its name.
  std::uint64_t size_ = 0;
  bool synced_ = false, committed_ = false;
};

/// Where a file that the user names is written: if it is a link to a file, what that leads to, so
/// that the link stays a link. @throws DataError for a link to nothing, or to no file
std::filesystem::path output_target(const std::filesystem::path& named);

/// Puts the names in `folder` on the disk, where its file system can do that. @throws DataError if
/// the disk fails
void sync_folder(const std::filesystem::path& folder);

/// Makes `folder`, and those above it, where they are not there yet, and puts the names of those
/// that were made on the disk, so that what is written in them later can be found again.
/// @return why one of them cannot be made; no error if all are there
/// @throws DataError as `sync_folder`
std::error_code make_folders(const std::filesystem::path& folder);

}  // namespace raymoval
