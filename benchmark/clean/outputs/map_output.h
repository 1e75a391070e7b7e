// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/clean/rows/voxel_rows.h"
#include "core/files/replacements.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {

/// Which points a map has.
struct MapContent {
  bool kept = true;
  bool removed = false;
  bool labelled = false;  ///< With the field of `labelled_layout`.
};

/// `layout` with a field added at its end: 9 = kept, 251 = removed. Its name is `label`, or
/// `raymoval_label` if `layout` already has a field `label`.
RecordLayout labelled_layout(const RecordLayout& layout);

/// A map in the world frame. With a voxel size it holds a row for each occupied cell, so that
/// memory is bounded by the map. Without one it passes rows on as they come, and memory is bounded
/// by a scan.
class MapOutput : public CleanOutput {
 public:
  /// @param layout of all rows, without a label
  /// @param voxel_size in metres; 0 keeps every point
  /// @throws UsageError, DataError as `PointRecordWriter`
  MapOutput(const std::filesystem::path& path, const RecordLayout& layout, MapContent content,
            double voxel_size, const Eigen::Vector3d& voxel_origin);

  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }
  [[nodiscard]] std::uint64_t points() const override { return points_; }

 private:
  /// The kept points or the removed points.
  struct Side {
    std::uint8_t mask;
    std::unique_ptr<VoxelRows> cells;
  };
  void pass_on(const CleanedScan& scan);
  void write(const ScanRows& rows);
  [[nodiscard]] ScanRows with_label(const ScanRows& rows,
                                    const std::vector<std::uint8_t>& removed) const;

  PointRecordWriter file_;
  RecordLayout layout_;  ///< Of the written rows.
  bool labelled_;
  std::vector<Side> sides_;
  bool has_cells_;
  std::uint64_t points_ = 0;
};

}  // namespace raymoval
