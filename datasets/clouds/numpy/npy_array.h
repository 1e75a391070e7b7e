// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/clouds/format/stored_points.h"

namespace raymoval {

/// The points of an array.
struct NpyPoints {
  StoredPoints stored;
  std::uint64_t width = 0, height = 1;
  bool unnamed = false;  ///< As in `RecordLayout`.
};

/// @param file an .npy file
/// @throws DataError naming what of its head cannot be, or that there are fewer or more bytes than
/// it
///   announces; UsageError if the point layout does not fit the array
NpyPoints npy_points(const CloudBytes& file);

}  // namespace raymoval
