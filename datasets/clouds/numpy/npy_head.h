// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// A field of an array's items, or the whole item if it has no fields (then the name is empty).
struct NpyField {
  PointField field;
  bool big_endian = false;
};

/// The type of an array's items.
struct NpyType {
  std::vector<NpyField> fields;
  std::size_t bytes = 0;    ///< Of an item, including padding.
  bool structured = false;  ///< Whether the items have named fields.
};

/// The head of an .npy file, and the bytes behind it.
struct NpyHead {
  NpyType type;
  bool by_columns = false;  ///< Fortran order.
  std::vector<std::uint64_t> shape;
  std::string_view body;

  /// "7 x 4 x 4", for messages.
  [[nodiscard]] std::string shape_text() const;
};

/// @param file an .npy file that outlives the result
/// @throws DataError naming an invalid part of its head
NpyHead npy_head(const CloudBytes& file);

}  // namespace raymoval
