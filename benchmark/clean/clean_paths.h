// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// What stands at an output's path when it is written.
enum class OutputKind {
  kCloud,    ///< A file of points, whose format is that of its extension.
  kPicture,  ///< A .png file.
  kPage,     ///< A .html file.
  kLabels,   ///< A folder of label files.
  kTiles,    ///< A folder of tiles with a manifest.json.
  kScans,    ///< A folder of scans with a cleaned.json.
};

bool is_folder_output(OutputKind kind);

/// One output, and the option that asked for it.
struct OutputPath {
  std::string option;
  std::filesystem::path path;
  OutputKind kind;
};

/// Everything that `raymoval clean` writes, and where. What is empty is not written.
struct CleanPaths {
  std::filesystem::path map = {};       ///< Cleaned map.
  std::filesystem::path removed = {};   ///< Removed points as a map.
  std::filesystem::path labelled = {};  ///< All points with a field that says what became of them.
  std::filesystem::path labels = {};    ///< Folder for a label file for each scan.
  std::filesystem::path scans = {};     ///< Folder of scans without removed points.
  std::filesystem::path page = {};      ///< HTML page with a 3-D view.
  std::filesystem::path picture = {};   ///< PNG from above.
  bool tiled = false;                   ///< Whether maps are folders of tiles.
  bool overwrite = false;               ///< Whether outputs may exist already.

  /// Those that are written, the most important first.
  [[nodiscard]] std::vector<OutputPath> all() const;
  /// The first of the maps that is written; empty if none is.
  [[nodiscard]] const std::filesystem::path& first_map() const {
    return !map.empty() ? map : !removed.empty() ? removed : labelled;
  }
};

/// All files that a sequence is read from, as far as it says so.
std::vector<std::filesystem::path> files_of(const Sequence& sequence);

/// The record that stands in a folder of tiles or of scans and lists its files; else empty. Only
/// such a folder is replaced.
const char* record_name(OutputKind kind);

/// Refuses paths that could not be written after the work is done, or that would destroy something:
/// unknown extensions, missing folders, the same place twice or one within another, and what exists
/// already. @throws UsageError that names the path and the remedy
void check_paths(const CleanPaths& paths);

/// Refuses to write over what `sequence` is read from, or among it: over pose files, calibration,
/// labels and scans, whatever links lead there; maps beside scans, where they would be taken for
/// scans; folders around inputs.
/// @param inputs files that were read besides those of the sequence
/// @throws UsageError
void check_apart_from(const Sequence& sequence, const CleanPaths& paths,
                      const std::vector<std::filesystem::path>& inputs = {});

}  // namespace raymoval
