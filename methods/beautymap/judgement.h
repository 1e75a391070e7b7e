// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/beautymap/scan_window.h"

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
Marks judge(const Parameters& parameters, const ColumnMap& map, const ScanWindow& window);

/// Steps 4 to 6 for one column of the window: slices that the map has and the scan has not, without
/// those that are out of sight, and without the lowest. Bit i is slice i.
std::uint32_t suspicious_slices(const Parameters& parameters, const ColumnMap& map,
                                const ScanWindow& window, int x, int y);

/// Step 7: which of these slices are hidden, because on the way to them the scan has something.
std::uint32_t hidden_slices(const Parameters& parameters, const Lattice& lattice,
                            const ScanWindow& window, int x, int y, std::uint32_t suspicious);

/// Step 8: the parts above the ground of a slice. Bit i is part i.
std::uint32_t parts_above_ground(const Parameters& parameters, const Lattice& lattice,
                                 const Column& column, int slice);

/// Adds what a scan says to the map.
void add_marks(const Marks& marks, ColumnMap& map);

}  // namespace raymoval::beautymap_method
