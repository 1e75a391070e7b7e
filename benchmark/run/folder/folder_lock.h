// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/file_lock.h"

namespace raymoval {

/// Keeps two runs from writing to one folder, for as long as it lives.
class FolderLock {
 public:
  using Mode = FileLock::Mode;

  /// @throws UsageError naming process and host if somebody holds it; DataError if the file cannot
  /// be written
  FolderLock(const std::filesystem::path& file, Mode mode);

 private:
  FileLock lock_;
};

}  // namespace raymoval
