// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/folder_lock.h"

#include "core/error.h"

namespace raymoval {
namespace {

FileLock::State taken(FileLock& lock, FileLock::Mode mode) {
  try {
    return lock.take(mode);
  } catch (const DataError& error) {
    throw DataError(std::string(error.what()) + " Nothing was changed; choose another --out.");
  }
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& file, Mode mode)
    : lock_(file), state_(taken(lock_, mode)) {
  if (state_ != FileLock::State::kBusy) return;
  throw UsageError(file.parent_path().string() + ": another run is writing there (" +
                   lock_.holder() + "). Wait for its end, or choose another --out.");
}

}  // namespace raymoval
