// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/files/descriptor.h"

namespace raymoval {

/// An advisory lock on a file (flock). The lock ends with its process, also if the process is
/// killed. The file only names the holder, and is removed with the lock.
class FileLock {
 public:
  enum class Mode {
    kShared,     ///< Others may hold it too, as long as all share it.
    kExclusive,  ///< Only one holder.
  };
  enum class State {
    kHeld,
    kBusy,     ///< Another process holds it.
    kNoLocks,  ///< The file system has no locks.
  };

  /// Nothing is locked, opened or made before `take`.
  explicit FileLock(std::filesystem::path file) : path_(std::move(file)) {}
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// Takes the lock if it is free; does not wait.
  /// @throws DataError if the file cannot be made, or the system cannot find out whether it is free
  State take(Mode mode);

  /// "process 123 on somewhere", as the holder wrote it.
  [[nodiscard]] std::string holder() const;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void open();
  /// Removes a file that was made in vain.
  void remove_if_new();
  [[nodiscard]] bool is_still_there() const;
  void write_holder() const;

  std::filesystem::path path_;
  Descriptor file_;
  bool is_new_ = false;  ///< Whether this object made the file.
};

}  // namespace raymoval
