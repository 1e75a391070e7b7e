// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace raymoval {

/// A folder of its own below the system's folder for temporary files (TMPDIR, else /tmp), for its
/// owner only. It is gone with this object. A process that is killed leaves its folder behind; its
/// lock is free then, and `remove_abandoned_working_folders` or the next folder made removes it.
class WorkingFolder {
 public:
  /// @throws DataError if it cannot be made
  WorkingFolder();
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Leaves the folder where it is.
  void keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
  bool kept_ = false;
};

/// Removes what killed processes of this user left. Never throws.
void remove_abandoned_working_folders();

}  // namespace raymoval
