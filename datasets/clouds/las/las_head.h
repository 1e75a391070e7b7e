// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/clouds/las/extra_bytes.h"
#include "datasets/clouds/las/las_notes.h"

namespace raymoval {

/// What the head of a LAS file says, checked against the bytes that there are.
struct LasHead {
  int format = 0;                ///< Of the points, 0 to 10.
  std::size_t record_bytes = 0;  ///< Of a point, extra bytes among them.
  std::uint64_t points = 0;
  std::uint64_t first_point = 0;  ///< Bytes before the points.
  std::vector<ExtraField> extra;
  std::shared_ptr<LasNotes> notes;
};

/// @throws DataError for a version that is not 1.0 to 1.4, for LAZ, for counts and lengths that do
///   not fit the bytes there are, for scales that are none
LasHead read_las_head(const CloudBytes& file);

}  // namespace raymoval
