// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "benchmark/clean/rows/map_precision.h"
#include "benchmark/clean/rows/row_layout.h"
#include "core/progress.h"
#include "datasets/sequence.h"

namespace raymoval {

/// The points of a scan as rows of a map.
struct ScanRows {
  PointRecords rows;  ///< Row i is point i of the scan, with x, y and z in the world frame.
  std::vector<Eigen::Vector3d> world;  ///< The same positions before they were rounded, metres.
};

/// Makes rows of a map out of scans. All fields that are stored of a point go through bit for bit,
/// but for two:
/// - x, y and z are those of the world frame. Points that are stored in the world frame stay as
///   they are.
/// - normals of points that are stored in the sensor frame are turned with their scan.
/// Points that have no records, such as those of a scene in memory, have x, y, z and intensity (0
/// in scans without reflectance).
class MapRows {
 public:
  /// Looks at the fields of all scans. Those of the first scan count.
  /// @param sequence must outlive this object
  /// @throws DataError if a scan has other fields, naming it and the field; Cancelled
  MapRows(const Sequence& sequence, Coordinates coordinates, Progress& progress,
          const std::atomic<bool>& cancel);

  /// Of all rows.
  [[nodiscard]] const RecordLayout& layout() const { return layout_; }
  /// Whether x, y and z of the map are float64 although no scan has them so.
  [[nodiscard]] bool is_widened() const { return is_widened_; }

  /// The rows of all points of `scan`. Thread-safe.
  /// @param stored its records; null if the sequence has none
  /// @throws DataError if the records have changed since they were looked at
  [[nodiscard]] ScanRows rows(const Scan& scan, const PointRecords* stored) const;

 private:
  void check_fields(const Sequence& sequence, Progress& progress, const std::atomic<bool>& cancel);
  [[nodiscard]] std::vector<Eigen::Vector3d> world_points(const Scan& scan,
                                                          const PointRecords* stored) const;
  /// What a LAS file of the map takes over from the scan's.
  [[nodiscard]] std::shared_ptr<const LasNotes> las_notes(const PointRecords& stored) const;
  void turn_normals(const Scan& scan, PointRecords& rows) const;

  const Sequence& sequence_;
  PointFrame frame_ = PointFrame::kSensor;
  RecordLayout stored_;  ///< Of the first scan.
  RecordLayout layout_;
  std::vector<NormalFields> normals_;
  bool is_widened_ = false;
};

}  // namespace raymoval
