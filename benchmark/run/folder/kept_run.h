// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/results.h"
#include "benchmark/suite/suite.h"
#include "core/scan/mask_store.h"
#include "datasets/sequence.h"

namespace raymoval {

/// A cell of a run folder. Its points can be shown if its removals were kept.
struct KeptCell {
  std::string sequence;
  std::string name;  ///< Name of the method in the suite.
  bool control = false;
  std::string status;              ///< Of the cell; "not run" if there is no such cell.
  std::string reason;              ///< Why there is no result.
  const Cell* cell = nullptr;      ///< Null if it was not run.
  std::filesystem::path removals;  ///< Folder of label files.

  [[nodiscard]] bool has_result() const { return cell != nullptr && cell->ok(); }
  /// Whether `run --keep-removals` stored its removals.
  [[nodiscard]] bool has_removals() const;
};

/// A finished run whose sequences are opened again, to show the methods' verdicts on points.
class KeptRun {
 public:
  /// @param run its folder
  /// @param data the new place of the sequences: one sequence's folder, or a folder that holds them
  ///   by their names; empty: the places in run.json
  /// @throws UsageError if there is no such run, or no folder `data`; DataError if its files are
  ///   damaged
  /// @param simulate whether scenes that are not in the cache are generated
  KeptRun(const std::string& run, const std::string& data, bool simulate = false);

  /// Copies would refer to the cells of the original.
  KeptRun(const KeptRun&) = delete;
  KeptRun& operator=(const KeptRun&) = delete;

  /// The content of results.json.
  [[nodiscard]] const ResultsRecord& record() const { return record_; }
  /// The part that tables show.
  [[nodiscard]] const RunResults& results() const { return results_; }
  /// Every sequence x method of the suite in the run's order, also those without a result.
  [[nodiscard]] const std::vector<KeptCell>& cells() const { return cells_; }
  /// @throws UsageError suggesting the nearest name
  [[nodiscard]] const KeptCell& cell(const std::string& sequence, const std::string& name) const;
  [[nodiscard]] std::vector<const KeptCell*> cells_of(const std::string& sequence) const;

  /// Opens a sequence as the run did, and checks that its data is still the same. run.json may be
  /// foreign and name any path: no file is made there, and only a sequence with the run's number of
  /// scans is read.
  /// @throws DataError naming the searched places, or that the data changed; Cancelled
  [[nodiscard]] Sequence open(const std::string& sequence, const OpenContext& context) const;

  /// The points of the sequence that a method removed. They are checked to be those of the method's
  /// scores.
  /// @throws DataError if the removals were not kept, are damaged, or are another run's
  [[nodiscard]] MaskStore masks(const KeptCell& cell, const Sequence& sequence) const;

 private:
  /// @throws DataError if neither run.json nor --data has it
  [[nodiscard]] SequenceRequest place_of(const std::string& sequence) const;
  [[nodiscard]] std::string fingerprint_of(const std::string& sequence) const;
  /// Scans that a sequence had in the run; 0 if that is not known.
  [[nodiscard]] std::size_t scans_of(const std::string& sequence) const;
  /// Opens the sequence at `path`. @throws DataError if it is not that of the run
  [[nodiscard]] Sequence open_at(const std::string& path, const std::string& sequence,
                                 const SequenceRequest& place, const OpenContext& context) const;

  std::filesystem::path folder_;
  std::string data_;
  bool simulate_;
  ResultsRecord record_;  ///< Its sequences have the places of run.json.
  RunResults results_;
  std::vector<KeptCell> cells_;
};

/// The remedy for a cell without kept removals.
std::string keep_removals_remedy(const KeptCell& cell);

}  // namespace raymoval
