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
  double voxel_size = 0.0;       ///< Metres; 0 keeps every point.
  std::string method = "clean";  ///< The method's name in pictures and pages.
  bool confidence = false;       ///< Whether maps have the field of `layout_with_confidence`.
};

/// The outputs of `raymoval clean`. The constructor opens all of them, so that a path that cannot
/// be written and a field that a format cannot hold are found before the work. `commit` renames all
/// outputs together: until then no file is replaced, and an error or an interruption leaves no file
/// behind.
class CleanOutputs {
 public:
  /// @param sequence must outlive this object
  /// @throws UsageError if a format cannot hold a required field; DataError if scans have different
  ///   fields, or a path cannot be written; Cancelled
  CleanOutputs(const CleanPaths& paths, const CleanWriting& writing, const Sequence& sequence,
               Progress& progress, const std::atomic<bool>& cancel);

  /// Scans come in order. @param mask 1 = removed, 0 = kept, `kLeftOutMask` = in no output
  /// @param confidence of each point in steps (`kConfidenceSteps`), if it is written or shown
  void add(const Scan& scan, const Mask& mask, const std::string& confidence = {});
  /// Finishes all outputs, which may fail on a full disk, and then renames them.
  void commit();

  /// Points of the first map after `commit`, if there is a map.
  [[nodiscard]] std::optional<std::uint64_t> map_points() const;
  /// Notes for the user before the work: fields that a format cannot hold, coordinates that become
  /// float64.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  /// Notes for the user on the written files, after `commit`.
  [[nodiscard]] std::vector<std::string> results() const;
  /// Whether the folder of --scans gets its own pose file, so that the poses that the user gave no
  /// longer apply to it.
  [[nodiscard]] bool has_own_poses() const { return has_own_poses_; }

 private:
  void add_map(const OutputPath& output, const CleanWriting& writing,
               const Eigen::Vector3d& voxel_origin);
  void add_views(const CleanPaths& paths, const CleanWriting& writing);
  void note_losses(const OutputPath& output, const RecordLayout& layout);

  const Sequence& sequence_;
  std::optional<MapRows> rows_;
  RecordLayout layout_;  ///< Of all rows.
  bool has_confidence_ = false;
  std::vector<std::unique_ptr<CleanOutput>> outputs_;
  const CleanOutput* first_map_ = nullptr;
  bool has_own_poses_ = false;
  std::vector<std::string> notes_;
};

}  // namespace raymoval
