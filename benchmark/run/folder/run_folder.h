// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "benchmark/suite/suite.h"
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

/// Name of the lock of a run folder, and of a cell's folder.
inline constexpr const char* kLockFile = "run.lock";

/// Name of the file by which a run's folder is recognised.
inline constexpr const char* kRunMarker = ".raymoval-run";

/// Makes the folder of a run and marks it. Without a marker it may be new or empty, hold only cells
/// of a run, or have the run.json of a run.
/// @throws UsageError for any other folder, which is not changed; DataError
void prepare_run_folder(const std::filesystem::path& out);

/// @throws DataError if the folder of a run was moved or removed from `out`
void check_run_folder_stays(const std::filesystem::path& out);

/// Whether this path is a record of a run, in the run folder or in a cell's folder. Pages and
/// pictures that a user put there are none.
bool is_record_of_run(const std::filesystem::path& file);

/// Removes half-written results of killed runs, by names that only runs use. The caller holds the
/// folder's lock.
void sweep_run_folder(const std::filesystem::path& out);

/// The run.json of a run: the resolved suite, its cells, build and machine, and the places of its
/// sequences. `merged_run_record` adds earlier content of the folder.
/// @param jobs how many cells run at once
RunRecord run_record(const Suite& suite, const std::vector<Sequence>& sequences, int threads,
                     int jobs = 1);

/// Writes results.csv, table.md, table.tex and, last, results.json. @throws DataError
void write_result_files(const std::filesystem::path& out, const ResultsRecord& results);

}  // namespace raymoval
