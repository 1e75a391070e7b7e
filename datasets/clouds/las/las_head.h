// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"
#include "datasets/clouds/las/las_fields.h"

namespace raymoval {

/// Facts from the head of a LAS file that are copied to a LAS file written from its points.
struct LasNotes {
  Eigen::Vector3d scale, offset;  ///< Metres: a coordinate is a whole number times scale + offset.
  /// The description (192 bytes) of each field in the extra bytes, by the field's name.
  std::map<std::string, std::string> extra_bytes;
  std::string reference_system;    ///< WKT; empty if there is none.
  bool standard_gps_time = false;  ///< GPS time is adjusted standard time, not of the week.
};

/// The head of a LAS file, checked against the size of the file.
struct LasHead {
  int format = 0;                ///< Of the points, 0 to 10.
  std::size_t record_bytes = 0;  ///< Of a point, including extra bytes.
  std::uint64_t points = 0;
  std::uint64_t first_point = 0;  ///< Bytes before the points.
  std::vector<ExtraField> extra;
  std::shared_ptr<LasNotes> notes;
};

/// @throws DataError for a version that is not 1.0 to 1.4, for LAZ, for counts and lengths that do
///   not fit the size of the file, and for invalid scales
LasHead read_las_head(const CloudBytes& file);

}  // namespace raymoval
