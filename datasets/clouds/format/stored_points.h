// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// The places of a field's values in the bytes of a file: value `at` of point i begins at
/// `start + i * step + at * field.size`.
struct StoredColumn {
  PointField field;  ///< Its offset is the place of the value in a record.
  std::size_t start = 0;
  std::size_t step = 0;
  bool big_endian = false;
};

/// Points whose values are stored uncompressed in `bytes`. All columns lie within `bytes`.
struct StoredPoints {
  std::string_view bytes;
  std::vector<StoredColumn> columns;
  std::size_t points = 0;
  std::size_t row_bytes = 0;                              ///< Of the records to be made.
  std::shared_ptr<const std::string> unpacked = nullptr;  ///< The owner of `bytes`, if not a file.
};

/// All fields of the points. A column whose field has no name is padding: its bytes are kept, but
/// the layout has no field for it.
/// @throws std::bad_alloc; the caller has checked the rows against the bytes
PointRecords records_of(const StoredPoints& stored);

/// The positions and intensities of the points.
/// @param origin metres, subtracted from each point in double precision before rounding to float32
/// @throws DataError naming `where` if x, y or z is missing
Cloud cloud_of(const StoredPoints& stored, const Eigen::Vector3d& origin, const std::string& where);

/// x, y, z and perhaps the intensity among `layout`, in this order.
/// @throws DataError naming `where` if x, y or z is missing
std::vector<PointField> cloud_fields(const RecordLayout& layout, const std::string& where);

/// The origin of column `column` of x, y, z, intensity; 0 for the intensity.
inline double origin_of(std::size_t column, const Eigen::Vector3d& origin) {
  return column < 3 ? origin[static_cast<Eigen::Index>(column)] : 0.0;
}

}  // namespace raymoval
