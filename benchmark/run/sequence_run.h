// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "benchmark/run/cell_run.h"
#include "benchmark/run/opened_suite.h"
#include "benchmark/run/runner.h"
#include "benchmark/tables/cell_line.h"

namespace raymoval {

/// Does `work(i)` for each i from 0 to count - 1, on `jobs` threads of which the caller's is one. A
/// free thread takes the lowest remaining number. After an exception no further number is taken;
/// the exception of the lowest number is thrown when all threads have ended.
void run_side_by_side(int jobs, std::size_t count, const std::function<void(std::size_t)>& work);

/// Runs the cells of a suite, sequence after sequence, and stores them in the run folder. With
/// `RunOptions::jobs`, several run at once: a free job takes the next cell, also of the next
/// sequence.
class SequenceRuns {
 public:
  /// Both must outlive this object.
  SequenceRuns(OpenedSuite& suite, JoinedFolder& folder);

  /// Runs the cells that are not stored yet. @throws Cancelled; DataError if results cannot be
  /// written
  void run();
  /// The same for one sequence, one cell after the other.
  void run(std::size_t sequence);

  /// The cells in the order of `OpenedSuite::cells`; no value if one was neither run nor stored.
  [[nodiscard]] const std::vector<std::optional<Cell>>& finished() const { return finished_; }
  /// How many cells there are and which of them failed.
  [[nodiscard]] const RunSummary& summary() const { return summary_; }
  /// @throws DataError if none of the sequences could be read
  void check_any_readable() const;

 private:
  /// A sequence that jobs share. The first job that needs it opens it; the last one releases it.
  struct SharedSequence {
    std::mutex mutex;
    bool is_opened = false;
    std::shared_ptr<ScoredSequence> scored;  ///< Null if it is not needed or cannot be read.
    std::size_t cells_left = 0;
  };
  [[nodiscard]] bool is_side_by_side() const { return suite_.options().jobs > 1; }
  void run_all_side_by_side();
  void run_job(SharedSequence& shared, CellIndex index);
  /// @return null if there is nothing to do
  std::shared_ptr<ScoredSequence> open_shared(SharedSequence& shared, std::size_t sequence);
  /// The pose fit of the same data in run.json. @return no value if it was not measured
  [[nodiscard]] std::optional<PoseFitRecord> known_pose_fit(const std::string& sequence,
                                                            const std::string& fingerprint);
  /// Puts the fingerprint into run.json. @return false if the data cannot be read
  bool read_data(ScoredSequence& scored, std::size_t sequence);
  /// Fails all cells of the sequence in the tables. Stored results are not changed.
  void fail_all(std::size_t sequence, const std::string& reason);
  void describe(std::size_t sequence);
  /// True if this cell is selected and may be run, so that its stored result may be replaced.
  [[nodiscard]] bool may_run(CellIndex index) const;
  void run_cell(ScoredSequence& scored, CellIndex index);
  /// Marks times that were taken while other cells ran.
  void mark_times(std::optional<Measurement>& measured) const;
  [[nodiscard]] MethodTask task_for(ScoredSequence& scored, CellIndex index) const;
  void show_running(CellIndex index);
  void show_stopped(CellIndex index);
  void finish(CellIndex index, Cell cell, bool was_there);

  OpenedSuite& suite_;
  JoinedFolder& folder_;
  CellLines lines_;
  std::mutex
      mutex_;  ///< Guards the data that jobs share: all members below, run.json and the progress.
  std::set<std::string> running_;
  std::vector<std::optional<Cell>> finished_;  ///< Each place belongs to the job that has the cell.
  RunSummary summary_;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace raymoval
