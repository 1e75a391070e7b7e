// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/clean/rows/row_layout.h"
#include "core/progress.h"
#include "core/scan/scan_source.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/sequence.h"

namespace raymoval {

/// Settings by which the coordinates of a map lose no digits.
struct MapPrecision {
  /// The origin from which voxels are counted, see `lattice_origin`.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// float64 where a sensor is so far from the world's origin that float32 loses a millimetre.
  Coordinates coordinates = Coordinates::kFloat;
};
MapPrecision map_precision(const ScanSource& scans);

/// The points of a scan as rows of a map.
struct ScanRows {
  PointRecords rows;  ///< Row i is point i of the scan, with x, y and z in the world frame.
  std::vector<Eigen::Vector3d> world;  ///< The same positions before they were rounded, metres.
};

/// Makes rows of a map out of scans. All stored fields of a point are copied bit for bit, except:
/// - x, y and z are those of the world frame. Points that are stored in the world frame are not
///   changed.
/// - normals of points that are stored in the sensor frame are rotated with their scan. Points that
/// have no records, such as those of a scene in memory, have x, y, z and intensity (0 in scans
/// without reflectance).
class MapRows {
 public:
  /// Checks the fields of all scans against those of the first scan.
  /// @param sequence must outlive this object
  /// @throws DataError if a scan has other fields, naming it and the field; Cancelled
  MapRows(const Sequence& sequence, Coordinates coordinates, Progress& progress,
          const std::atomic<bool>& cancel);

  /// Of all rows.
  [[nodiscard]] const RecordLayout& layout() const { return layout_; }
  /// Whether x, y and z of the map are float64 although all scans have smaller types.
  [[nodiscard]] bool is_widened() const { return is_widened_; }

  /// The rows of all points of `scan`. Thread-safe.
  /// @param stored its records; null if the sequence has none
  /// @throws DataError if the records have changed since the constructor read them
  [[nodiscard]] ScanRows rows(const Scan& scan, const PointRecords* stored) const;

 private:
  void check_fields(const Sequence& sequence, Progress& progress, const std::atomic<bool>& cancel);
  [[nodiscard]] std::vector<Eigen::Vector3d> world_points(const Scan& scan,
                                                          const PointRecords* stored) const;
  void turn_normals(const Scan& scan, PointRecords& rows) const;

  const Sequence& sequence_;
  PointFrame frame_ = PointFrame::kSensor;
  RecordLayout stored_;  ///< Of the first scan.
  RecordLayout layout_;
  std::vector<NormalFields> normals_;
  bool is_widened_ = false;
};

/// `layout` with a field added at its end. The field's name is `name`, or `raymoval_<name>` if
/// `layout` already has a field `name`.
/// @param type,size as those of RecordLayout::add
RecordLayout layout_with_field(const RecordLayout& layout, std::string name, char type, int size);

/// Rows of such a layout: `rows`, each followed by the bytes of `value_of(row)`.
/// @param layout of `layout_with_field`, whose size is that of a value
template <class ValueOf>
ScanRows rows_with_field(const ScanRows& rows, const RecordLayout& layout, ValueOf value_of) {
  const std::size_t size = rows.rows.size();
  ScanRows result{{layout, std::vector<std::byte>(size * layout.row_bytes), size, 1}, rows.world};
  const std::size_t bytes = rows.rows.layout.row_bytes;
  for (std::size_t i = 0; i < size; ++i) {
    const auto value = value_of(i);
    std::memcpy(result.rows.row(i), rows.rows.row(i), bytes);
    std::memcpy(result.rows.row(i) + bytes, &value, sizeof value);
  }
  return result;
}

/// `layout` with a float32 field added at its end: the method's confidence that a point moves, from
/// 0 to 1. The field's name is `confidence`, or `raymoval_confidence` if `layout` already has a
/// field `confidence`.
RecordLayout layout_with_confidence(const RecordLayout& layout);

/// Rows of that layout: `rows`, and the confidence of each.
/// @param steps of each row's point, see `kConfidenceSteps`
ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps);

}  // namespace raymoval
