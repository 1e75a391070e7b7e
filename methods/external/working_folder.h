// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"

namespace raymoval::external_method {

/// A new folder below the system's folder for temporary files (TMPDIR, else /tmp) that only its
/// owner can read. It is removed with this object. A process that is killed leaves its folder
/// behind; then its lock is free (see `new_part_folder`), and `remove_abandoned_working_folders` or
/// whoever makes the next folder removes it.
class WorkingFolder {
 public:
  /// @param is_kept it gets a name of its own, and is never removed
  /// @throws DataError if it cannot be made
  explicit WorkingFolder(bool is_kept);
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return part_.place; }

 private:
  Part part_;
  bool is_kept_;
};

}  // namespace raymoval::external_method
