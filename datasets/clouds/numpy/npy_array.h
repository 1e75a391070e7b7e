// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/clouds/format/stored_points.h"
#include "datasets/clouds/numpy/npy_type.h"

namespace raymoval {

/// What the head of an .npy file says, and the bytes that follow it.
struct NpyHead {
  NpyType type;
  bool by_columns = false;  ///< Fortran order.
  std::vector<std::uint64_t> shape;
  std::string_view body;

  /// "7 x 4 x 4", for messages.
  [[nodiscard]] std::string shape_text() const;
};

/// @param file an .npy file, which has to live as long as what is returned
/// @throws DataError naming what of its head cannot be
NpyHead npy_head(const CloudBytes& file);

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
