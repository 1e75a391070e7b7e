// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/run/folder/cell_store.h"
#include "benchmark/run/folder/folder_content.h"
#include "benchmark/run/run_options.h"
#include "benchmark/run/scored_sequence.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// Identifies a cell of a suite by the numbers of its sequence and method.
struct CellIndex {
  std::size_t sequence = 0;
  std::size_t method = 0;
};

/// A suite with opened sequences and a selection of cells.
class OpenedSuite {
 public:
  /// Both arguments must outlive this object.
  /// @throws UsageError, DataError or ConfigurationError if the suite cannot be run
  OpenedSuite(const Suite& suite, const RunOptions& options);

  [[nodiscard]] const Suite& suite() const { return suite_; }
  [[nodiscard]] const RunOptions& options() const { return options_; }
  [[nodiscard]] const CellStore& store() const { return store_; }
  /// Threads of each method; one if several cells run at once.
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] const std::vector<Sequence>& sequences() const { return sequences_; }

  /// All cells, sequence after sequence.
  [[nodiscard]] const std::vector<CellName>& cells() const { return cells_; }
  /// The index of a cell in `cells`.
  [[nodiscard]] std::size_t place(CellIndex cell) const {
    return cell.sequence * suite_.methods.size() + cell.method;
  }
  [[nodiscard]] const CellName& name(CellIndex cell) const { return cells_[place(cell)]; }
  [[nodiscard]] const MethodRequest& method(CellIndex cell) const {
    return suite_.methods[cell.method];
  }

  [[nodiscard]] bool is_selected(CellIndex cell) const { return selected_[place(cell)]; }
  /// Selects only this cell. Other cells are not used, even if they are in the folder.
  void select_only(CellIndex cell);
  [[nodiscard]] bool is_alone() const { return alone_; }
  /// Whether a cell of the sequence must be run or may be stored. Otherwise its data is not read.
  [[nodiscard]] bool is_needed(std::size_t sequence) const;

  /// The sequence with its protocols: the one of `give_back`, which already has its fingerprint, or
  /// a new one.
  [[nodiscard]] ScoredSequence take_sequence(std::size_t sequence);
  void give_back(std::size_t sequence, ScoredSequence scored);

  /// The state of a cell in the run folder. @throws DataError if the data cannot be read
  [[nodiscard]] StoredCell stored_cell(ScoredSequence& scored, CellIndex cell) const;

  /// The cell with the name "SEQUENCE/NAME", or with this key, for which the data is read.
  /// @throws UsageError if there is none
  [[nodiscard]] CellIndex find(const std::string& wanted);

  /// Writes a line to the log, if there is one.
  void say(const std::string& line) const;

 private:
  const Suite& suite_;
  const RunOptions& options_;
  CellStore store_;
  int threads_;
  std::vector<Sequence> sequences_;
  std::vector<CellName> cells_;
  std::vector<bool> selected_;  ///< As `cells_`.
  bool alone_ = false;
  std::vector<std::optional<ScoredSequence>> scored_sequences_;  ///< By sequence.
};

/// A run folder to which a run is added.
struct JoinedFolder {
  RunRecord record;      ///< The content for run.json.
  EarlierCells earlier;  ///< Not read for a run that `is_alone`.
};

/// Checks that the run and the content of its folder belong together, and reads the cells of
/// earlier runs. @throws UsageError if they do not belong together; DataError
JoinedFolder join_folder(OpenedSuite& suite);

}  // namespace raymoval
