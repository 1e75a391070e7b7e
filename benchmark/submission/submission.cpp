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

std::vector<path> files_of(const path& given) {
  if (!is_there(given)) {
    throw DataError(given.string() +
                    ": no such file or folder; expected a cell.json of a run, a folder with such "
                    "files, or a run folder.");
  }
  if (!is_folder(given)) return {given};
  std::vector<path> files;
  if (has_folder(given / "cells")) {
    files = cells_of_run(given);
  } else {
    for (const path& entry : entries_of(given)) {
      if (entry.extension() == ".json" && is_file(entry)) files.push_back(entry);
    }
  }
  if (files.empty()) {
    throw DataError(given.string() +
                    ": holds no cell; expected files cell.json as `raymoval run` writes them.");
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
