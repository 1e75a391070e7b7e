// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "benchmark/clean/map_cleaner.h"
#include "core/files/part_name.h"
#include "core/files/replacements.h"
#include "datasets/sequence.h"

namespace raymoval {

/// The files that `raymoval clean` is to write.
struct CleanPaths {
  std::filesystem::path map;      ///< Cleaned map.
  std::filesystem::path removed;  ///< Removed points as a map; empty: none is written.
  std::filesystem::path labels;   ///< Folder for a label file per scan; empty: none is written.
  bool overwrite = false;         ///< Whether these may exist already.
};

/// Refuses paths that could not be written after the work is done, or that would destroy something:
/// unknown extensions, missing folders, the same file twice, and files that exist already.
/// @throws UsageError that names the path and the remedy
void check_paths(const CleanPaths& paths);

/// Refuses to write among the files of `sequence`: maps beside its scans, where they would be taken
/// for scans, and labels over its labels. @throws UsageError
void check_apart_from(const Sequence& sequence, const CleanPaths& paths);

/// A folder of label files that gets its name when it is complete.
class LabelFolder {
 public:
  /// @throws DataError if it cannot be made
  explicit LabelFolder(const std::filesystem::path& path);
  ~LabelFolder();
  LabelFolder(const LabelFolder&) = delete;
  LabelFolder& operator=(const LabelFolder&) = delete;

  void add(const Scan& scan, const Mask& mask);
  /// Lets `together` give the folder its name, in place of a folder that had it. @throws DataError
  void commit_with(Replacements& together);

 private:
  std::filesystem::path path_;
  Part part_;
  bool committed_ = false;
};

/// The outputs of `raymoval clean`. All are opened at the beginning, so that a place where nothing
/// can be written is found before the work. They get their names at the end: until then nothing is
/// replaced, and an error or an interruption leaves nothing behind.
class CleanOutputs {
 public:
  /// @param voxel_size in metres; 0 keeps every point
  /// @throws UsageError if a file's format cannot hold the map's coordinates
  CleanOutputs(const CleanPaths& paths, double voxel_size, const MapPrecision& precision);
  void add(const Scan& scan, const Mask& mask);
  /// Ends all outputs, which may find the disk full, and then gives them their names.
  void commit();
  [[nodiscard]] std::uint64_t map_points() const { return map_points_; }

 private:
  MapWriter map_;
  std::optional<MapWriter> removed_;
  std::optional<LabelFolder> labels_;
  std::uint64_t map_points_ = 0;
};

}  // namespace raymoval
