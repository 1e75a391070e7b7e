// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/beautymap/column_map.h"

namespace raymoval::beautymap_method {

/// What one scan says of the map.
struct Marks {
  struct Slices {
    std::uint32_t column;
    std::uint32_t slices;  ///< Bit i: slice i goes.
  };
  struct Parts {
    std::uint32_t column;
    int slice;
    std::uint32_t parts;  ///< Bit i: part i of the slice goes.
  };
  std::vector<Slices> slices;
  std::vector<Parts> parts;
};

/// Section B of the description: what the map has and the scan has not, where nothing says that the
/// scan could not see it.
/// @param placed where the scan's points are in the map
Marks judge(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
            const std::vector<PlacedPoint>& placed);

/// Adds what a scan says to the map.
void add_marks(const Marks& marks, ColumnMap& map);

}  // namespace raymoval::beautymap_method
