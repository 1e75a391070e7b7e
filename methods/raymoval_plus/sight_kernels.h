// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/simd/simd.h"

/// Loops of `RangeImage`, compiled for each instruction set; all give the same numbers.
namespace raymoval::kernels {

/// Where places are looked up in a range image. Columns go once around, from azimuth -pi on.
struct SightGrid {
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F;
  float elevation_min = 0.0F;  ///< Of row 0, radians.
  int columns = 0;
};

/// Places x y z, x y z, ... of any frame, metres.
struct SightPlaces {
  const float* places = nullptr;
  std::size_t count = 0;
  std::array<float, 9> rotation{};  ///< To the sensor frame, row by row.
  std::array<float, 3> translation{};
};

/// Range and bin of each place, arrays with room for `count` rounded up to 16.
struct Sights {
  float* range = nullptr;  ///< Metres.
  std::int32_t* column = nullptr;
  std::int32_t* row = nullptr;  ///< May lie outside the image.
};

/// Nearest and farthest return of the least window around each bin: pairs, row by row.
struct SightWindows {
  const float* pairs = nullptr;
  int stride = 0;  ///< Pairs in a row.
  int margin = 0;  ///< Pairs before column 0.
  int rows = 0;
  float least_range = 0.0F;                  ///< Nearer than this, windows are larger.
  float agree[2] = {0.0F, 0.0F};             ///< Constant and slope.
  float range_min = 0.0F, range_max = 0.0F;  ///< Nothing is asked about what lies outside.
};

struct SightKernels {
  void (*locate)(const SightGrid& grid, const SightPlaces& places, const Sights& sights);
  /// The same, and the numbers of places to be looked at closer into `chosen`, ascending: not
  /// those out of range, nor those of whose least window it is known that nothing returned from it
  /// or that all that did hides them. @return how many
  std::size_t (*choose)(const SightGrid& grid, const SightPlaces& places,
                        const SightWindows& windows, const Sights& sights, std::uint32_t* chosen);
};

SightKernels sight_kernels_for(InstructionSet set);

}  // namespace raymoval::kernels
