// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "benchmark/clean/map_cleaner.h"
#include "datasets/sequence.h"

namespace raymoval {

/// What `raymoval clean` is to write, and where.
struct CleanPaths {
  std::filesystem::path map;      ///< Cleaned map.
  std::filesystem::path removed;  ///< Removed points as a map; empty: none is written.
  std::filesystem::path labels;   ///< Folder for a label file per scan; empty: none is written.
  bool overwrite = false;         ///< Whether these may be there already.
};

/// Refuses what could not be written after the work is done, or would destroy something: unknown
/// extensions, missing folders, the same file twice, and what is there already.
/// @throws UsageError naming the path and the remedy
void check_paths(const CleanPaths& paths);

/// Refuses to write among the files of `sequence`: maps beside its scans, where they would be taken
/// for scans, and labels over its labels. @throws UsageError
void check_apart_from(const Sequence& sequence, const CleanPaths& paths);

/// A folder of label files that appears as a whole.
class LabelFolder {
 public:
  /// @throws DataError if it cannot be made
  explicit LabelFolder(const std::filesystem::path& path);
  ~LabelFolder();
  LabelFolder(const LabelFolder&) = delete;
  LabelFolder& operator=(const LabelFolder&) = delete;

  void add(const Scan& scan, const Mask& mask);
  /// Gives the folder its name; one that was there goes. @throws DataError
  void commit();

 private:
  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path path_, temporary_, old_;
};

/// The outputs of `raymoval clean`, all open from the beginning, so that a place where nothing can
/// be written shows before the work, and named at the end only: until then nothing is replaced, and
/// an error or an interruption leaves nothing behind.
class CleanOutputs {
 public:
  /// @param voxel_size metres; 0 keeps every point
  /// @throws UsageError if a file's format cannot hold the map's coordinates
  CleanOutputs(const CleanPaths& paths, double voxel_size, const MapPrecision& precision);
  void add(const Scan& scan, const Mask& mask);
  /// Ends and names all outputs: first what takes room, then the names.
  void commit();
  [[nodiscard]] std::uint64_t map_points() const { return map_points_; }

 private:
  MapWriter map_;
  std::optional<MapWriter> removed_;
  std::optional<LabelFolder> labels_;
  std::uint64_t map_points_ = 0;
};

}  // namespace raymoval
