// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/descriptor.h"

namespace raymoval::external_method {

/// A new folder below the system's folder for temporary files (TMPDIR, else /tmp) that only its
/// owner can read. It is removed with this object. A process that is killed leaves its folder
/// behind; then the lock of the folder is free, and `remove_abandoned_working_folders` or whoever
/// makes the next folder removes it.
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
  Descriptor lock_;
  bool kept_ = false;
};

}  // namespace raymoval::external_method
