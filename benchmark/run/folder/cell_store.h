// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "benchmark/result/cell.h"
#include "benchmark/result/run_record.h"
#include "core/scan/scan_source.h"

namespace raymoval {

/// The state of a cell in a run folder.
struct StoredCell {
  enum class State {
    kMissing,  ///< There is no such cell.
    kStale,    ///< It has other parameters, data, protocols or versions, or is damaged.
    kFailed,   ///< It is the wanted cell, and it failed.
    kFresh,    ///< It is the wanted cell, and complete.
  };
  State state = State::kMissing;
  std::string why;           ///< Why it must be run, in words; empty if it is fresh.
  std::optional<Cell> cell;  ///< The cell, if it failed or is fresh.
};

/// The folder cells/ of a run. A process that is ended at any moment leaves the old cell or the new
/// one. If removals are kept, it may leave none: removals are many files, and no cell may be beside
/// the removals of another cell.
class CellStore {
 public:
  explicit CellStore(std::filesystem::path out) : out_(std::move(out)) {}

  [[nodiscard]] std::filesystem::path folder(const CellName& cell) const;
  /// A new path in the cell's folder, to which removals are written before `keep`.
  [[nodiscard]] std::filesystem::path new_removals(const CellName& cell) const;

  /// @param scans if given, the cell's removals must exist for these scans too
  /// @param confidence whether the cell's confidence must have been scored
  [[nodiscard]] StoredCell find(const CellName& name, const CellIdentity& wanted,
                                const ScanSource* scans, bool confidence = false) const;
  /// Whether there is a complete cell with a result, of any run. @throws UnreadableError
  [[nodiscard]] bool has_result(const CellName& cell) const;

  /// Makes the cell's folder and removes files of a killed run. It is called before the method
  /// runs, so that no result is computed that cannot be stored.
  /// @throws DataError, also if `keep` would remove files that no run made
  void prepare(const CellName& cell) const;
  /// Stores a cell, and new removals if there are any, in place of the earlier cell.
  /// @param removals the folder of `new_removals`; none were kept if it is empty or not there
  /// @throws DataError if a file cannot be written, or if a file that no run made would be lost;
  /// then nothing has changed
  void keep(const Cell& cell, const std::filesystem::path& removals = {}) const;
  /// Removes half-written files of killed runs from the cells' folders, by names that only runs use
  /// (see `is_part_name`). The caller holds the folder's lock.
  void sweep() const;

 private:
  std::filesystem::path out_;
};

/// Makes a folder and its parents, and syncs their names to the disk (see `make_folders`).
/// @throws DataError pointing to --out
void make_folder(const std::filesystem::path& folder);

}  // namespace raymoval
