// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// A cell that somebody hands in: what a method scored on a sequence, and where its masks are.
struct SubmittedCell {
  std::filesystem::path file;   ///< The cell.json.
  std::filesystem::path masks;  ///< The folder of label files; it need not be there.
  std::string from;             ///< Name of the submission, for tables: the last part of its path.
  Cell cell;
};

/// Reads a submission. `path` is one of:
/// - a cell.json, as `raymoval run` writes it, by any name that ends in .json;
/// - a folder that has such files, one for each sequence;
/// - a run folder: all its cells.
/// The masks of a cell are in the folder `removals` beside it, where `run --keep-removals` puts
/// them.
/// @param masks if not empty, the folder of the masks instead: DIR, or DIR/SUBMISSION by the name
/// of the submission; in it a folder for each sequence, which may be left out if there is one
/// @param alone whether no other submission shares `masks`. If one does, a submission without a
/// folder in it has its own masks beside it.
/// @return at least one cell, in the order of the files' names
/// @throws DataError if nothing is there, or a file cannot be read, is damaged or is no cell
std::vector<SubmittedCell> read_submission(const std::filesystem::path& path,
                                           const std::filesystem::path& masks, bool alone);

}  // namespace raymoval
