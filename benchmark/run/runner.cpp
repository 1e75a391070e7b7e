// SPDX-License-Identifier: MIT
#include "benchmark/run/runner.h"

#include <algorithm>

#include "benchmark/result/checks/controls_check.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/folder/run_folder.h"
#include "benchmark/run/sequence_run.h"

namespace raymoval {
namespace {

/// The results of all stored cells that belong to the folder.
ResultsRecord collected_results(const OpenedSuite& suite, const JoinedFolder& folder,
                                const std::vector<std::optional<Cell>>& finished,
                                RunSummary& summary) {
  ResultsRecord results{folder.record};
  const std::vector<CellName>& asked = suite.cells();
  for (const CellName& name : folder.record.cells) {
    const auto place = std::find(asked.begin(), asked.end(), name) - asked.begin();
    const bool is_asked = static_cast<std::size_t>(place) < asked.size();
    const Cell* earlier = is_asked ? nullptr : folder.earlier.find(name);
    if (is_asked && finished[place]) {
      results.cells.push_back(*finished[place]);
    } else if (earlier != nullptr) {
      results.cells.push_back(*earlier);
    } else {
      results.missing.push_back(name.title());
      if (is_asked) summary.missing.push_back(name.title());
    }
  }
  results.controls_checked = folder.record.controls;
  if (results.controls_checked) results.control_problems = check_controls(results.cells);
  return results;
}

/// A file system without locks is used too; then the user must prevent parallel runs.
void warn_if_unlocked(const OpenedSuite& suite, const FolderLock& lock) {
  if (lock.is_held()) return;
  suite.say("warning: the file system of " + suite.options().out.string() +
            " has no locks, so another run could write there at the same time. Start none before "
            "this run has ended.");
}

/// Does the work of a run. If its folder was moved, any write error is reported as the moved
/// folder.
template <class Work>
void work_in_folder(const std::filesystem::path& out, Work&& work) {
  try {
    work();
  } catch (const DataError&) {
    check_run_folder_stays(out);
    throw;
  }
}

}  // namespace

RunSummary run_suite(const Suite& suite, const RunOptions& options) {
  OpenedSuite opened(suite, options);
  prepare_run_folder(options.out);
  const FolderLock lock(options.out / kLockFile, FolderLock::Mode::kExclusive);
  warn_if_unlocked(opened, lock);
  sweep_run_folder(options.out);
  JoinedFolder folder = join_folder(opened);
  opened.store().sweep();
  write_run_record(options.out / "run.json", folder.record);
  for (const std::string& line : folder.earlier.lines()) opened.say(line);
  SequenceRuns runs(opened, folder);
  work_in_folder(options.out, [&] { runs.run(); });
  runs.check_any_readable();
  RunSummary summary = runs.summary();
  summary.earlier = folder.earlier.kept.size();
  const ResultsRecord results = collected_results(opened, folder, runs.finished(), summary);
  summary.controls = results.control_problems;
  check_run_folder_stays(options.out);
  write_result_files(options.out, results);
  return summary;
}

RunSummary run_one_cell(const Suite& suite, const RunOptions& options, const std::string& cell) {
  OpenedSuite opened(suite, options);
  const CellIndex index = opened.find(cell);
  const std::filesystem::path folder = opened.store().folder(opened.name(index));
  prepare_run_folder(options.out);
  const FolderLock run_lock(options.out / kLockFile, FolderLock::Mode::kShared);
  opened.select_only(index);
  JoinedFolder joined = join_folder(opened);
  make_folder(folder);
  const FolderLock cell_lock(folder / kLockFile, FolderLock::Mode::kExclusive);
  warn_if_unlocked(opened, cell_lock);
  SequenceRuns runs(opened, joined);
  work_in_folder(options.out, [&] { runs.run(index.sequence); });
  return runs.summary();
}

}  // namespace raymoval
