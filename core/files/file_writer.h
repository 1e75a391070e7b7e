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

/// Writes a file piece by piece. Its path keeps the old content until `commit`, and has all of the
/// new content from then on. Until then the pieces are in a temporary file beside it (see
/// `new_part_file`), which is removed with the writer. A file that is replaced keeps its rights,
/// and its owner if the system allows that. A link is replaced, and its target stays (see
/// `output_target`). Every member throws DataError naming the path and the system's reason (disk
/// full, no rights).
class FileWriter {
 public:
  explicit FileWriter(std::filesystem::path path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void append(std::string_view content);
  /// Replaces bytes that were appended, from `offset` on.
  void overwrite(std::uint64_t offset, std::string_view content);
  /// Writes all of it to the disk. After this, no step fails for lack of space.
  void sync();
  /// Gives the file its name.
  void commit();
  /// Writes all of it to the disk. `together` then gives the file its name.
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

/// Where a file that the user names is written: if it is a link to a file, the target of the link,
/// so that the link stays. @throws DataError for a link to nothing, or to no file
std::filesystem::path output_target(const std::filesystem::path& named);

/// Writes the names in `folder` to the disk, if its file system can do that. @throws DataError if
/// the disk fails
void sync_folder(const std::filesystem::path& folder);

/// Makes `folder` and missing folders above it, and writes the names of the new folders to the
/// disk, so that files written there later can be found after a crash.
/// @return why one of them cannot be made; no error if all are there
/// @throws DataError as `sync_folder`
std::error_code make_folders(const std::filesystem::path& folder);

}  // namespace raymoval
