// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/clean/clean_paths.h"
#include "benchmark/clean/outputs/clean_output.h"
#include "core/progress.h"
#include "datasets/sequence.h"

namespace raymoval {

/// How the outputs of `raymoval clean` are written.
struct CleanWriting {
  double voxel_size = 0.0;  ///< Metres; 0 keeps every point.
  double tile_size = 0.0;   ///< Metres; for maps that are folders of tiles.
  std::string tile_extension = ".pcd";
  std::optional<double> intensity_scale = std::nullopt;  ///< See `RecordWriting`.
  std::string method = "clean";                          ///< What pictures and pages call it.
  bool confidence = false;  ///< Whether maps have the field of `layout_with_confidence`.
};

/// The outputs of `raymoval clean`. All are opened at the beginning, so that a place where nothing
/// can be written, and what a format cannot hold, is found before the work. They get their names
/// together at the end: until then nothing is replaced, and an error or an interruption leaves
/// nothing behind.
class CleanOutputs {
 public:
  /// @param sequence must outlive this object
  /// @throws UsageError if a format cannot hold what it is to hold; DataError if scans have
  ///   different fields, or a place cannot be written; Cancelled
  CleanOutputs(const CleanPaths& paths, const CleanWriting& writing, const Sequence& sequence,
               Progress& progress, const std::atomic<bool>& cancel);

  /// Scans come in order. @param mask 1 = removed, 0 = kept, `kLeftOutMask` = in no output
  /// @param confidence of each point in steps (`kConfidenceSteps`), if it is written
  void add(const Scan& scan, const Mask& mask, const std::string& confidence = {});
  /// Ends all outputs, which may find the disk full, and then gives them their names.
  void commit();

  /// Points of the first map after `commit`, if there is a map.
  [[nodiscard]] std::optional<std::uint64_t> map_points() const;
  /// What a user should know before the work: fields that a format cannot hold, coordinates that
  /// became float64.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// What a user should know of what was written, after `commit`.
  [[nodiscard]] std::vector<std::string> results() const;
  /// Whether the folder of --scans has poses of its own, so that those that the user gave belong to
  /// it no more.
  [[nodiscard]] bool has_own_poses() const { return has_own_poses_; }

 private:
  void add_map(const OutputPath& output, const CleanPaths& paths, const CleanWriting& writing,
               const Eigen::Vector3d& voxel_origin);
  /// @throws UsageError for a scale of intensities that no map shows as whole numbers
  void check_intensity_scale(const std::vector<OutputPath>& outputs, const CleanPaths& paths,
                             const CleanWriting& writing) const;
  void add_views(const CleanPaths& paths, const CleanWriting& writing);
  void note_losses(const OutputPath& output, const std::string& name, const RecordLayout& layout);

  const Sequence& sequence_;
  std::optional<MapRows> rows_;
  RecordLayout layout_;  ///< Of all rows.
  bool has_confidence_ = false;
  std::vector<std::unique_ptr<CleanOutput>> outputs_;
  const CleanOutput* first_map_ = nullptr;
  const class ScanFolder* scans_ = nullptr;
  bool has_own_poses_ = false;
  std::vector<std::string> notes_;
};

}  // namespace raymoval
