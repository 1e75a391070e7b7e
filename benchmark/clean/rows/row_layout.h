// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "datasets/clouds/cloud_file.h"
#include "datasets/records/point_records.h"
#include "datasets/records/record_source.h"

namespace raymoval {

/// The layout of the rows of a map that is made of records of `stored`: the same fields in the same
/// order. In the sensor frame x, y and z become float64 for `Coordinates::kDouble`, and float32
/// where they are whole numbers; else the fields keep their types, and the rows their padding.
/// @throws DataError if x, y or z is missing
RecordLayout map_layout(const RecordLayout& stored, PointFrame frame, Coordinates coordinates,
                        const std::string& where);

/// The layout of a map of points that have no records: x y z intensity.
RecordLayout plain_layout(Coordinates coordinates);

/// What tells the fields of `layout` from those of `expected`, without regard of their order and
/// place: "has no field ring", "has the field rgb as well". Empty if they are the same.
std::string field_difference(const RecordLayout& layout, const RecordLayout& expected);

/// Three real numbers that are a direction: the surface normal of a point.
using NormalFields = std::array<PointField, 3>;
/// The normals among the fields: normal_x normal_y normal_z, nx ny nz, or one field `normal` with
/// three values.
std::vector<NormalFields> normal_fields(const RecordLayout& layout);

/// The real or whole number that is the strength of the return; null if there is none.
const PointField* intensity_field(const RecordLayout& layout);

/// Copies records of one layout into rows of another that has fields of the same names. A field
/// whose type differs is left for the caller to fill.
class RowCopy {
 public:
  RowCopy(const RecordLayout& from, const RecordLayout& to);
  void copy(const std::byte* from, std::byte* to) const {
    for (const Piece& piece : pieces_) {
      std::memcpy(to + piece.to, from + piece.from, piece.bytes);
    }
  }
  /// Whether rows are the same bytes before and after.
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  struct Piece {
    std::size_t from = 0, to = 0, bytes = 0;
  };
  std::vector<Piece> pieces_;
  bool is_whole_ = false;
};

}  // namespace raymoval
