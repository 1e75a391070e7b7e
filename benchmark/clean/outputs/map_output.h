// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/clean/rows/voxel_rows.h"
#include "core/files/replacements.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {

/// Counts intensities that lose their value in a file that stores them as whole numbers from 0 to
/// 65,535.
class IntensityCount {
 public:
  /// @param scale see `RecordWriting::intensity_scale`
  IntensityCount(ShownIntensity shown, double scale) : shown_(std::move(shown)), scale_(scale) {}

  /// @param rows of the layout that `shown` is a field of
  void add(const PointRecords& rows);
  /// Notes for the user, in sentences: most intensities are rounded to 0 or 1, or some are too
  /// large. @param option of the map, such as "-o"
  [[nodiscard]] std::vector<std::string> remarks(const std::string& option) const;

 private:
  ShownIntensity shown_;
  double scale_;
  std::uint64_t faint_ = 0;      ///< More than 0 and less than 1.
  std::uint64_t too_large_ = 0;  ///< More than 65,535.
  std::uint64_t positive_ = 0;
};

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
            double voxel_size, const Eigen::Vector3d& voxel_origin,
            const RecordWriting& writing = {});

  /// Counts the intensities that the map's file shows as whole numbers. @param option of the map
  void count_intensity(IntensityCount count, std::string option);

  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }
  [[nodiscard]] std::uint64_t points() const override { return points_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;

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
  std::optional<IntensityCount> intensity_;
  std::string option_;
};

}  // namespace raymoval
