// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/run/folder/cell_store.h"

namespace raymoval {

/// The content of run.json in `out`; no value if there is none.
/// @throws DataError if it is damaged or of another version, pointing to --overwrite
std::optional<RunRecord> present_record(const std::filesystem::path& out);

/// Why cells of the run `asked` cannot share a table with those of the folder's `present` run.json;
/// empty if they can. Results belong together if
/// - at most one of the two is a suite with a name, or both have the same name,
/// - sequences of one name were read in the same way (frames, poses, sensor, range, label rule),
/// - protocols and their options are the same,
/// - no two names share a folder.
std::string why_not_together(const RunRecord& present, const RunRecord& asked);

/// The same for a sequence's `fingerprint`, for which all of its data is read.
std::string why_other_data(const RunRecord& present, const std::string& sequence,
                           const std::string& fingerprint);

/// @throws UsageError with `why` and the remedy, unless `why` is empty
void refuse_other_results(const std::filesystem::path& out, const std::string& why);

/// The fingerprint that a run.json has of a sequence; empty if it has none.
std::string known_fingerprint(const RunRecord& record, const std::string& sequence);
/// Stores the fingerprint and the pose fit of a sequence in the record. @return whether that
/// changed it
bool set_reading(RunRecord& record, const std::string& sequence, const std::string& fingerprint,
                 const std::optional<PoseFitRecord>& fit);

/// run.json of a folder to which the run `asked` is added: the sequences, methods and cells of
/// both. Items of both are taken from `asked`, as are build and machine.
RunRecord merged_run_record(const RunRecord& present, const RunRecord& asked);

/// Cells of earlier runs that are not part of a run and stay in the folder's tables.
struct EarlierCells {
  std::vector<Cell> kept;
  /// "sequence / method: reason" of stored cells that no longer fit the others: their method or a
  /// protocol has other parameters or another version now.
  std::vector<std::string> left_out;

  /// Null if there is no such cell.
  [[nodiscard]] const Cell* find(const CellName& cell) const;
  /// A line for each sequence with its kept cells, and one for each cell that is left out.
  [[nodiscard]] std::vector<std::string> lines() const;
};

/// Reads the cells of `record` that `asked` does not have.
EarlierCells read_earlier_cells(const CellStore& store, const RunRecord& record,
                                const RunRecord& asked);

}  // namespace raymoval
