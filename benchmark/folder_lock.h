// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "benchmark/descriptor.h"

namespace raymoval {

/// Keeps two runs from writing to one folder. The file lock (flock) ends with the process however
/// that ends, so what a dead process left is taken over; the file only tells who holds it, and goes
/// away with the lock.
class FolderLock {
 public:
  enum class Mode {
    kShared,     ///< Others may hold it too, as long as all share it.
    kExclusive,  ///< Nobody else.
  };

  /// @throws UsageError naming process and host if somebody holds it; DataError if the file cannot
  /// be written
  FolderLock(std::filesystem::path file, Mode mode);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  [[nodiscard]] bool is_still_there() const;
  void write_holder() const;

  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace raymoval
