// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scan/scan_source.h"
#include "core/scan/voxel_key.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/records/point_records.h"
#include "datasets/records/record_source.h"
#include "datasets/sequence.h"

namespace raymoval {

/// The layout of the rows of a map that is made of records of `stored`: the same fields in the same
/// order. If points are stored in the sensor frame, x, y and z become float64 for
/// `Coordinates::kDouble`, and whole numbers become float32. All other fields keep their types, and
/// rows keep their padding.
/// @throws DataError if x, y or z is missing
RecordLayout map_layout(const RecordLayout& stored, PointFrame frame, Coordinates coordinates,
                        const std::string& where);

/// The layout of a map of points without records: x y z intensity.
RecordLayout plain_layout(Coordinates coordinates);

/// The difference between the fields of `layout` and `expected`, regardless of order and offset:
/// "has no field ring", "has the field rgb as well". Empty if there is none.
std::string field_difference(const RecordLayout& layout, const RecordLayout& expected);

/// Three real numbers: the surface normal of a point.
using NormalFields = std::array<PointField, 3>;
/// The normals among the fields: normal_x normal_y normal_z, nx ny nz, or one field `normal` with
/// three values.
std::vector<NormalFields> normal_fields(const RecordLayout& layout);

/// The field with the strength of the return; null if there is none.
const PointField* intensity_field(const RecordLayout& layout);

/// Copies records of one layout into rows of another that has fields of the same names. The caller
/// fills fields whose type differs.
class RowCopy {
 public:
  RowCopy(const RecordLayout& from, const RecordLayout& to);
  void copy(const std::byte* from, std::byte* to) const {
    for (const Piece& piece : pieces_) {
      std::memcpy(to + piece.to, from + piece.from, piece.bytes);
    }
  }
  /// Whether rows keep their bytes.
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  struct Piece {
    std::size_t from = 0, to = 0, bytes = 0;
  };
  std::vector<Piece> pieces_;
  bool is_whole_ = false;
};

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
  /// The parts of a scan's LAS header that a LAS file of the map takes over.
  [[nodiscard]] std::shared_ptr<const LasNotes> las_notes(const PointRecords& stored) const;
  void turn_normals(const Scan& scan, PointRecords& rows) const;

  const Sequence& sequence_;
  PointFrame frame_ = PointFrame::kSensor;
  RecordLayout stored_;  ///< Of the first scan.
  RecordLayout layout_;
  std::vector<NormalFields> normals_;
  bool is_widened_ = false;
};

/// `layout` with a float32 field added at its end: the method's confidence that a point moves, from
/// 0 to 1. The field's name is `confidence`, or `raymoval_confidence` if `layout` already has a
/// field `confidence`.
RecordLayout layout_with_confidence(const RecordLayout& layout);

/// Rows of that layout: `rows`, and the confidence of each.
/// @param steps of each row's point, see `kConfidenceSteps`
ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps);

/// Keeps one row for each occupied cell of space, so that memory is bounded by the map. A row has
/// the mean position and the mean intensity of the cell's points. All other fields are those of the
/// point nearest to the centre of the cell, the first of several.
class VoxelRows {
 public:
  /// @param cell_size in metres
  /// @param origin of the cells
  VoxelRows(const RecordLayout& layout, double cell_size, const Eigen::Vector3d& origin);

  /// Adds row `point` of a scan.
  void add(const ScanRows& scan, std::size_t point);
  /// Passes on all cells, ordered by x, then y, then z, in pieces, and releases them.
  void take(const std::function<void(const ScanRows& piece)>& give);

 private:
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< From `origin`.
    double intensity = 0.0;
    std::uint64_t count = 0;
    std::uint64_t row = 0;  ///< Number among those of `blocks_`.
    float from_middle = std::numeric_limits<float>::infinity();  ///< Squared, in cells.
  };
  [[nodiscard]] std::byte* row_of(const Cell& cell) const;
  void keep_row(Cell& cell, bool is_new, const std::byte* row);
  void append(const Cell& cell, ScanRows& piece) const;

  RecordLayout layout_;
  PositionFields at_;
  std::optional<PointField> intensity_;
  bool keeps_rows_;  ///< Whether rows have fields other than position and intensity.
  double cell_size_;
  Eigen::Vector3d origin_;
  VoxelMap<Cell> cells_;
  std::vector<std::unique_ptr<std::byte[]>> blocks_;  ///< Rows that never move.
  std::shared_ptr<const LasNotes> las_;               ///< Of the first scan.
};

}  // namespace raymoval
