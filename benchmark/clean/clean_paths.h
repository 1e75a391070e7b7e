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

/// The kind of file or folder at an output's path.
enum class OutputKind {
  kCloud,    ///< A file of points, whose format is that of its extension.
  kPicture,  ///< A .png file.
  kPage,     ///< A .html file.
  kLabels,   ///< A folder of label files.
  kScans,    ///< A folder of scans with a cleaned.json.
};

bool is_folder_output(OutputKind kind);

/// One output and its option.
struct OutputPath {
  std::string option;
  std::filesystem::path path;
  OutputKind kind;
};

/// The paths of all outputs of `raymoval clean`. An output with an empty path is not written.
struct CleanPaths {
  std::filesystem::path map = {};      ///< Cleaned map.
  std::filesystem::path removed = {};  ///< Removed points as a map.
  std::filesystem::path labels = {};   ///< Folder for a label file for each scan.
  std::filesystem::path scans = {};    ///< Folder of scans without removed points.
  std::filesystem::path page = {};     ///< HTML page with a 3-D view.
  std::filesystem::path picture = {};  ///< PNG from above.
  bool overwrite = false;              ///< Whether outputs may exist already.

  /// The outputs with a path, the most important first.
  [[nodiscard]] std::vector<OutputPath> all() const;
  /// The first map with a path; empty if there is none.
  [[nodiscard]] const std::filesystem::path& first_map() const {
    return !map.empty() ? map : removed;
  }
};

/// All known files that a sequence is read from.
std::vector<std::filesystem::path> files_of(const Sequence& sequence);

/// Name of the record in a folder of scans, which lists the folder's files; empty for
/// other kinds. Only a folder with such a record is replaced.
const char* record_name(OutputKind kind);

/// Refuses paths that could not be written after the work, or that would destroy something: unknown
/// extensions, missing folders, the same path twice or one within another, and existing files.
/// @throws UsageError that names the path and the remedy
void check_paths(const CleanPaths& paths);

/// Refuses outputs that would overwrite the inputs of `sequence` (pose files, calibration, labels,
/// scans; links are followed), maps beside scans, where a map would be read as a scan, and folders
/// that contain inputs.
/// @param inputs further files that were read
/// @throws UsageError
void check_apart_from(const Sequence& sequence, const CleanPaths& paths,
                      const std::vector<std::filesystem::path>& inputs = {});

}  // namespace raymoval
