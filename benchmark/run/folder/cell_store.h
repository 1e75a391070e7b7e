// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "benchmark/result/cell.h"
#include "benchmark/result/run_record.h"
#include "core/scan/scan_source.h"

namespace raymoval {

/// What a run folder holds of a cell.
struct StoredCell {
  enum class State {
    kMissing,  ///< There is none.
    kStale,    ///< It is of other parameters, data, protocols or versions, or it is damaged.
    kFailed,   ///< It is this very cell, and it failed.
    kFresh,    ///< It is this very cell, and whole.
  };
  State state = State::kMissing;
  std::string why;           ///< Why it has to be run, in words for a reader; empty if it is fresh.
  std::optional<Cell> cell;  ///< The cell, if it failed or is fresh.
};

/// The folder cells/ of a run. A process that is ended at any moment leaves either the old cell or
/// the new one, or none where removals are kept: these are many files, and no cell may stand beside
/// those of another one.
class CellStore {
 public:
  explicit CellStore(std::filesystem::path out) : out_(std::move(out)) {}

  [[nodiscard]] std::filesystem::path folder(const CellName& cell) const;
  /// A new name in the cell's folder, where removals are written before `keep`.
  [[nodiscard]] std::filesystem::path new_removals(const CellName& cell) const;

  /// @param scans if they are given, the cell's removals of them have to be there too
  /// @param confidence whether the cell's has to have been scored
  [[nodiscard]] StoredCell find(const CellName& name, const CellIdentity& wanted,
                                const ScanSource* scans, bool confidence = false) const;
  /// Repeat `number` (2, 3 ...) of the cell with `key`; no value if it is not there.
  [[nodiscard]] std::optional<RepeatRecord> find_repeat(const CellName& cell, int number,
                                                        const std::string& key) const;

  /// Whether there is a whole cell with a result, of whatever run. @throws UnreadableError
  [[nodiscard]] bool has_result(const CellName& cell) const;

  /// Makes the cell's folder and removes what a killed run left there. It is called before the
  /// method runs, so that nothing is computed for a place where it cannot be kept.
  /// @throws DataError, also if `keep` would have to remove what no run made
  void prepare(const CellName& cell) const;
  /// Puts a cell, and new removals if there are any, in the place of what was there.
  /// @param removals the folder of `new_removals`; none were kept if it is empty or not there
  /// @throws DataError if something cannot be written, or would be lost that no run made: then all
  /// that was there is there still
  void keep(const Cell& cell, const std::filesystem::path& removals = {}) const;
  void keep_repeat(const CellName& cell, const RepeatRecord& repeat) const;

  /// Removes half-written files of killed runs from the cells' folders, by names that only runs
  /// give (see `is_part_name`). The caller holds the folder's lock.
  void sweep() const;

 private:
  std::filesystem::path out_;
};

/// Makes a folder and those above it, with their names on the disk (see `make_folders`).
/// @throws DataError pointing to --out
void make_folder(const std::filesystem::path& folder);

}  // namespace raymoval
