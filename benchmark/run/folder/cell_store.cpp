// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/cell_store.h"

#include <system_error>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/checks/differences.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/files/part_name.h"

namespace raymoval {
namespace {

using std::filesystem::path;

constexpr const char* kRemovals = "removals";

/// Whether the kept removals are those of the cell's scores.
bool has_removals(const path& folder, const Cell& cell, const ScanSource& scans) {
  if (!cell.masks) return false;
  const auto kept = if_whole([&] { return read_removals(folder / kRemovals, scans, [] {}); });
  return kept && mask_digest(*kept) == cell.masks->digest;
}

/// Why a result file is not used.
std::string damage(const path& file) {
  return file.filename().string() + " is damaged or was changed by hand";
}

/// @throws DataError if a folder of removals holds files that no run writes
void check_replaceable(const path& removals) {
  if (can_remove_removals(removals)) return;
  throw DataError(removals.string() +
                  ": holds files that are not from a run, so it is not replaced. Move them away.");
}

/// Removes files of a killed run from a cell's folder, by names that only runs use.
void sweep_cell(const path& folder) {
  for (const path& entry : entries_of(folder)) {
    const path name = name_of_part(entry);
    if (name == kRemovals) remove_removals(entry);
    std::error_code ignored;
    if (name == "cell.json") std::filesystem::remove(entry, ignored);
  }
}

}  // namespace

void make_folder(const path& folder) {
  const std::error_code error = make_folders(folder);
  if (error) {
    throw DataError(folder.string() + ": cannot be made (" + error.message() +
                    "). Choose another --out.");
  }
}

path CellStore::folder(const CellName& cell) const {
  return out_ / "cells" / folder_name(cell.sequence) / folder_name(cell.name);
}

path CellStore::new_removals(const CellName& cell) const {
  return new_part_name(folder(cell) / kRemovals);
}

StoredCell CellStore::find(const CellName& name, const CellIdentity& wanted,
                           const ScanSource* scans, bool confidence) const {
  using State = StoredCell::State;
  const path file = folder(name) / "cell.json";
  if (!has_file(file)) return {State::kMissing, "is not there yet", {}};
  try {
    Cell cell = read_cell(file);
    const bool same = cell.key == cell_key(wanted);
    if (!cell.ok()) {
      const std::string why = "failed last time: " + cell.reason;
      if (!same) return {State::kStale, why, {}};
      return {State::kFailed, why, std::move(cell)};
    }
    if (!same) return {State::kStale, identity_difference(cell, wanted), {}};
    if (scans != nullptr && !has_removals(folder(name), cell, *scans)) {
      return {State::kStale, "its removals are requested, but missing or incomplete", {}};
    }
    if (confidence && !cell.reliability) {
      return {State::kStale, "its confidence is requested, but was not scored", {}};
    }
    return {State::kFresh, "", std::move(cell)};
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError&) {
    return {State::kStale, damage(file), {}};
  }
}

bool CellStore::has_result(const CellName& cell) const {
  const auto stored = if_whole([&] { return read_cell(folder(cell) / "cell.json"); });
  return stored && stored->ok();
}

void CellStore::prepare(const CellName& cell) const {
  make_folder(folder(cell));
  check_replaceable(folder(cell) / kRemovals);
  sweep_cell(folder(cell));
}

void CellStore::keep(const Cell& cell, const path& removals) const {
  const path cell_folder = folder({cell.sequence, cell.name});
  const path place = cell_folder / kRemovals;
  make_folder(cell_folder);
  const bool has = !removals.empty() && has_folder(removals);
  if (has || is_there(place)) {
    check_replaceable(place);
    // A cell is never stored beside the removals of another cell.
    remove_if_there(cell_folder / "cell.json");
    if (!remove_removals(place)) {
      throw DataError(place.string() + ": something was put into it meanwhile. Move it away.");
    }
  }
  if (has) {
    std::error_code error;
    std::filesystem::rename(removals, place, error);
    if (error) throw DataError(place.string() + ": cannot be made (" + error.message() + ").");
  }
  write_cell(cell_folder / "cell.json", cell);
}

void CellStore::sweep() const {
  if (!has_folder(out_ / "cells")) return;
  for (const path& sequence : folders_in(out_ / "cells")) {
    for (const path& cell : folders_in(sequence)) sweep_cell(cell);
  }
}

}  // namespace raymoval
