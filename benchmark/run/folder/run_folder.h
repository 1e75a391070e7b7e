// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// Name of the lock of a run folder, and of a cell's folder.
inline constexpr const char* kLockFile = "run.lock";

/// Name of the file by which a run's folder is recognised.
inline constexpr const char* kRunMarker = ".raymoval-run";

/// Makes the folder of a run and marks it. Without a marker it may be new or empty, hold nothing
/// but the cells of a run, or have the run.json of an earlier version.
/// @throws UsageError for any other folder, in which nothing is changed; DataError
void prepare_run_folder(const std::filesystem::path& out);

/// @throws DataError if the folder of a run is no longer at `out`, because somebody moved or
/// removed it
void check_run_folder_stays(const std::filesystem::path& out);

/// Whether a run keeps a record at this path: in its folder, or in that of a cell. A page or a
/// picture that somebody put there is none.
bool is_record_of_run(const std::filesystem::path& file);

/// Removes half-written results of killed runs, by names that only runs give. The caller holds the
/// folder's lock.
void sweep_run_folder(const std::filesystem::path& out);

/// What run.json says of a run: the suite as resolved, its cells, build and machine, and the places
/// where its sequences are. `merged_run_record` adds what else the folder holds.
/// @param jobs how many cells run at once
RunRecord run_record(const Suite& suite, const std::vector<Sequence>& sequences, int threads,
                     int jobs = 1);

/// Writes results.csv, table.md, table.tex and, last, results.json. @throws DataError
void write_result_files(const std::filesystem::path& out, const ResultsRecord& results);

}  // namespace raymoval
