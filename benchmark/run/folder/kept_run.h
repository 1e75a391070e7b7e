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

/// A cell of a run folder, whose points can be looked at if its removals were kept.
struct KeptCell {
  std::string sequence;
  std::string name;  ///< Name of the method in the suite.
  bool control = false;
  std::string status;              ///< Of the cell; "not run" if there is no such cell.
  std::string reason;              ///< Why there is no result.
  const Cell* cell = nullptr;      ///< Null if it was not run.
  std::filesystem::path removals;  ///< Folder of label files.

  [[nodiscard]] bool has_result() const { return cell != nullptr && cell->ok(); }
  /// Whether `run --keep-removals` left what it removed.
  [[nodiscard]] bool has_removals() const;
};

/// A finished run whose sequences are opened again, to look at what methods did to their points.
class KeptRun {
 public:
  /// @param run its folder
  /// @param data where the sequences are now, if not where run.json says: one sequence's folder, or
  ///   a folder that holds them by their names; empty: as run.json says
  /// @throws UsageError if there is no such run, or no folder `data`; DataError if its files are
  ///   damaged
  /// @param simulate whether scenes are made that are not in the cache
  KeptRun(const std::string& run, const std::string& data, bool simulate = false);

  /// Copies would refer to the cells of the original.
  KeptRun(const KeptRun&) = delete;
  KeptRun& operator=(const KeptRun&) = delete;

  /// What results.json holds.
  [[nodiscard]] const ResultsRecord& record() const { return record_; }
  /// The same as tables show it.
  [[nodiscard]] const RunResults& results() const { return results_; }
  /// Every sequence x method of the suite in the run's order, also those without a result.
  [[nodiscard]] const std::vector<KeptCell>& cells() const { return cells_; }
  /// @throws UsageError suggesting the nearest name
  [[nodiscard]] const KeptCell& cell(const std::string& sequence, const std::string& name) const;
  [[nodiscard]] std::vector<const KeptCell*> cells_of(const std::string& sequence) const;

  /// Opens a sequence as the run did, and checks that its data is still the same. The run may be
  /// somebody else's, and run.json name any place: nothing is made there or read but a sequence
  /// with as many scans as the run had.
  /// @throws DataError saying where it was looked for, or that the data changed; Cancelled
  [[nodiscard]] Sequence open(const std::string& sequence, const OpenContext& context) const;

  /// What a method removed of the sequence. It is checked to be what the method was scored by.
  /// @throws DataError if the removals were not kept, are damaged, or are another run's
  [[nodiscard]] MaskStore masks(const KeptCell& cell, const Sequence& sequence) const;

 private:
  /// @throws DataError if neither run.json nor --data says it
  [[nodiscard]] SequenceRequest place_of(const std::string& sequence) const;
  [[nodiscard]] std::string fingerprint_of(const std::string& sequence) const;
  /// Scans that a sequence had in the run; 0 if that is not known.
  [[nodiscard]] std::size_t scans_of(const std::string& sequence) const;
  /// Opens what stands at `path`. @throws DataError if it is not what the run was made on
  [[nodiscard]] Sequence open_at(const std::string& path, const std::string& sequence,
                                 const SequenceRequest& place, const OpenContext& context) const;

  std::filesystem::path folder_;
  std::string data_;
  bool simulate_;
  ResultsRecord record_;  ///< Its sequences have the places of run.json.
  RunResults results_;
  std::vector<KeptCell> cells_;
};

/// What to do about a cell without kept removals.
std::string keep_removals_remedy(const KeptCell& cell);

}  // namespace raymoval
