// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"

namespace raymoval {

/// What a temporary folder is for: the beginning of its name.
inline constexpr const char* kRecordingFolder = "raymoval-recording";  ///< Decompressed recordings.
inline constexpr const char* kMethodFolder = "raymoval-external";      ///< External methods.

/// The folder for temporary files: TMPDIR, or /tmp if that is not set.
std::filesystem::path scratch_root();

/// A new folder below `scratch_root()` that only this user can enter. It is removed with this
/// object. A process that is killed leaves its folder behind. Its lock is then free (see
/// `new_part_folder`), and `remove_abandoned_scratch_folders` or the next process that makes such a
/// folder removes it.
class ScratchFolder {
 public:
  /// @param purpose one of the names above
  /// @param is_kept the folder gets a name of its own, and is never removed
  /// @throws DataError if it cannot be made
  explicit ScratchFolder(const char* purpose, bool is_kept = false);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return part_.place; }

 private:
  Part part_;
  bool is_kept_;
};

/// Removes the temporary folders that killed processes of this user have left. It never throws.
void remove_abandoned_scratch_folders();

}  // namespace raymoval
