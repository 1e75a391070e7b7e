// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/file_lock.h"

namespace raymoval {

/// Prevents two runs from writing to one folder, during its lifetime.
class FolderLock {
 public:
  using Mode = FileLock::Mode;

  /// @throws UsageError naming process and host if another process holds it; DataError if the file
  /// cannot be written or locked
  FolderLock(const std::filesystem::path& file, Mode mode);

  /// False on a file system without locks, where other runs are not prevented.
  [[nodiscard]] bool is_held() const { return state_ == FileLock::State::kHeld; }

 private:
  FileLock lock_;
  FileLock::State state_;
};

}  // namespace raymoval
