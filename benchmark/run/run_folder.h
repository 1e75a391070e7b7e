// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/result/results.h"
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

/// Removes half-written results of killed runs, by names that only runs give. Only for who holds
/// the folder's lock.
void sweep_run_folder(const std::filesystem::path& out);

/// Content of run.json: the suite as resolved, its cells, build and machine, and the places where
/// its sequences are. What else the folder holds is added by `merged_run_record`.
nlohmann::ordered_json run_record(const Suite& suite, const std::vector<Sequence>& sequences,
                                  int threads);

/// What results.json is made of.
struct RunContent {
  const nlohmann::ordered_json* record = nullptr;
  const std::vector<nlohmann::ordered_json>* cells = nullptr;
  bool controls_checked = true;
  std::vector<std::string> control_problems;
  std::vector<std::string> missing;  ///< "sequence / method".
};

/// Writes results.csv, table.md, table.tex and, last, results.json. @return what the tables are
/// made of
/// @throws DataError
RunResults write_results(const std::filesystem::path& out, const RunContent& content);

}  // namespace raymoval
