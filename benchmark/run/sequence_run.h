// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/run/cell_run.h"
#include "benchmark/run/opened_suite.h"
#include "benchmark/run/runner.h"
#include "benchmark/tables/cell_line.h"

namespace raymoval {

/// A cell of a run with the further runs of its method.
struct FinishedCell {
  std::optional<Cell> cell = std::nullopt;  ///< No value if it was not run and is not there.
  std::vector<Measurement> repeats = {};
};

/// Runs the cells of a suite, sequence after sequence, and puts them into the run folder.
class SequenceRuns {
 public:
  /// Both have to live as long as this object.
  SequenceRuns(OpenedSuite& suite, JoinedFolder& folder);

  /// Runs those cells of a sequence that are not there yet. @throws Cancelled; DataError if results
  /// cannot be written
  void run(std::size_t sequence);

  /// What came of the cells, in the order of `OpenedSuite::cells`.
  [[nodiscard]] const std::vector<FinishedCell>& finished() const { return finished_; }
  /// How many cells there are and which of them failed.
  [[nodiscard]] const RunSummary& summary() const { return summary_; }
  /// @throws DataError if none of the sequences could be read
  void check_any_readable() const;

 private:
  /// Puts the fingerprint into run.json. @return false if the data cannot be read
  bool read_data(ScoredSequence& scored, std::size_t sequence);
  void fail_all(std::size_t sequence, const std::string& reason);
  void describe(std::size_t sequence) const;
  void run_cell(ScoredSequence& scored, CellIndex index);
  void repeat(ScoredSequence& scored, CellIndex index, int round);
  std::optional<RepeatRecord> run_again(ScoredSequence& scored, CellIndex index, int round);
  void fail_repeat(CellIndex index, int round, CellStatus status, const std::string& reason);
  [[nodiscard]] CellTask task_for(ScoredSequence& scored, CellIndex index) const;
  void show_running(CellIndex index, const std::string& round) const;
  void finish(CellIndex index, Cell cell, bool was_there);

  OpenedSuite& suite_;
  JoinedFolder& folder_;
  CellLines lines_;
  std::vector<FinishedCell> finished_;
  RunSummary summary_;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace raymoval
