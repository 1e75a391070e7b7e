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

}  // namespace raymoval
