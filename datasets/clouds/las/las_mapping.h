// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/clouds/las/las_layout.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// Where the fields of points go in the records of a LAS file.
struct LasMapping {
  /// A field that LAS has.
  struct Standard {
    PointField from;
    LasField to;
  };
  /// Bytes of a field that LAS does not have: a value, or up to 255 bytes that belong together.
  struct Extra {
    PointField from;   ///< Its offset is that of the bytes in the records.
    std::string name;  ///< At most 32 bytes.
    std::string of;    ///< The field's own name.
  };
  int format = 6;
  std::size_t record_bytes = 0;
  std::vector<Standard> standard;
  std::vector<Extra> extra;
  /// Fields that the extra bytes have, and that are also written where viewers look for them.
  const PointField *shown_intensity = nullptr, *shown_colour = nullptr, *shown_angle = nullptr;
  /// The bits of the return number and the number of returns, of which points without them have 1.
  unsigned assumed_returns = 0x11;
};

/// @param layout outlives the result
LasMapping map_to_las(const RecordLayout& layout);

/// Whether `field` can go where LAS has `to`, each value as it is.
bool fits(const PointField& field, const LasField& to);

}  // namespace raymoval
