// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// A field of an array's items, or all of an item that has no fields (then its name is empty).
struct NpyField {
  PointField field;
  bool big_endian = false;
};

/// What the items of an array are.
struct NpyType {
  std::vector<NpyField> fields;
  std::size_t bytes = 0;    ///< Of an item, padding among them.
  bool structured = false;  ///< Whether the items have named fields.
};

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

}  // namespace raymoval
