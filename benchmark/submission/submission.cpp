// SPDX-License-Identifier: MIT
#include "benchmark/submission/submission.h"

#include <set>

#include "benchmark/result/cell_json.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

using std::filesystem::path;

/// cells/SEQUENCE/METHOD/cell.json of a run folder.
std::vector<path> cells_of_run(const path& folder) {
  std::vector<path> files;
  for (const path& sequence : folders_in(folder / "cells")) {
    for (const path& cell : folders_in(sequence)) {
      if (has_file(cell / "cell.json")) files.push_back(cell / "cell.json");
    }
  }
  return files;
}

/// The .json files that stand in `folder` itself.
std::vector<path> json_files_in(const path& folder) {
  std::vector<path> files;
  for (const path& entry : entries_of(folder)) {
    if (entry.extension() == ".json" && is_file(entry)) files.push_back(entry);
  }
  return files;
}

bool looks_submitted(const path& folder) {
  try {
    return has_folder(folder / "cells") || !json_files_in(folder).empty();
  } catch (const DataError&) {
    return false;  // It cannot be listed, so it is not proposed.
  }
}

/// results/submissions, or cells/05 of a run: what can be verified stands in the folder.
std::string hint_below(const path& folder) {
  for (const path& below : folders_in(folder)) {
    if (!looks_submitted(below)) continue;
    return " Give the folders in it instead, such as " + below.string() + ".";
  }
  return "";
}

/// A run's own records are no cells, though they stand beside `cells`.
void check_no_record_of_run(const path& file) {
  const path folder = std::filesystem::absolute(file).parent_path();
  const bool record = file.filename() == "results.json" || file.filename() == "run.json";
  if (!record || !has_folder(folder / "cells")) return;
  throw DataError(file.string() + ": is about a whole run; expected the run folder " +
                  folder.string() + ", or a cell.json below its folder cells.");
}

std::vector<path> files_of(const path& given) {
  if (!is_there(given)) {
    throw DataError(given.string() +
                    ": no such file or folder; expected a cell.json of a run, a folder with such "
                    "files, or a run folder.");
  }
  if (!is_folder(given)) {
    check_no_record_of_run(given);
    return {given};
  }
  std::vector<path> files =
      has_folder(given / "cells") ? cells_of_run(given) : json_files_in(given);
  if (files.empty()) {
    throw DataError(given.string() +
                    ": holds no cell; expected files cell.json as `raymoval run` writes them." +
                    hint_below(given));
  }
  return files;
}

/// "voxel_counts" of results/submissions/voxel_counts/ and of a file in it.
std::string name_of(const path& given) {
  path named = std::filesystem::absolute(given).lexically_normal();
  if (!is_folder(named)) named = named.parent_path();
  if (named.filename().empty()) named = named.parent_path();
  return named.filename().string();
}

}  // namespace

std::vector<SubmittedCell> read_submission(const path& given, const path& masks, bool alone) {
  std::vector<SubmittedCell> cells;
  std::set<std::string> sequences;
  for (const path& file : files_of(given)) {
    cells.push_back({file, file.parent_path() / "removals", name_of(given), read_cell(file)});
    sequences.insert(cells.back().cell.sequence);
  }
  if (masks.empty()) return cells;
  if (!is_folder(masks)) {
    throw DataError("--masks " + masks.string() +
                    ": no such folder; expected the folder of a label file for each scan.");
  }
  const bool named = has_folder(masks / name_of(given));
  if (!named && !alone) return cells;
  const path base = named ? masks / name_of(given) : masks;
  if (cells.size() != sequences.size()) {
    throw UsageError("--masks " + base.string() + ": " + given.string() +
                     " has several methods; verify them one by one.");
  }
  for (SubmittedCell& cell : cells) {
    const path own = base / cell.cell.sequence;
    cell.masks = sequences.size() > 1 || has_folder(own) ? own : base;
  }
  return cells;
}

}  // namespace raymoval
