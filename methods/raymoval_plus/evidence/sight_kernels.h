// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The loops of `RangeImage`. They are compiled for each instruction set, and all give the same
/// numbers.
namespace raymoval::raymoval_plus_method::kernels {

/// The most places that any instruction set takes at once.
inline constexpr std::size_t kMostLanes = 16;

/// How directions become bins of a range image. Columns go once around, from azimuth -pi on.
struct SightGrid {
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F;
  float elevation_min = 0.0F;  ///< Lower edge of row 0, radians.
  int columns = 0;
};

/// Places x y z, x y z, ... of any frame, metres.
struct SightPlaces {
  const float* places = nullptr;
  std::size_t count = 0;
  std::array<float, 9> rotation{};  ///< To the sensor frame, row by row.
  std::array<float, 3> translation{};
};

/// The range and the bin of each place. Each array has room for `kMostLanes` more than there are.
struct Sights {
  float* range = nullptr;  ///< Metres.
  std::int32_t* column = nullptr;
  std::int32_t* row = nullptr;  ///< May lie outside the image.
};

/// The nearest and the farthest return of the least window around each bin: pairs, row by row.
struct SightWindows {
  const float* pairs = nullptr;
  int stride = 0;  ///< Pairs in a row.
  int margin = 0;  ///< Pairs before column 0.
  int rows = 0;
  float least_range = 0.0F;                  ///< Nearer places have larger windows.
  std::array<float, 2> agree{};              ///< Metres at range 0, and for each metre of range.
  float range_min = 0.0F, range_max = 0.0F;  ///< Places beyond are not chosen.
};

struct SightKernels {
  /// Finds the range and the bin of each place.
  void (*locate)(const SightGrid& grid, const SightPlaces& places, const Sights& sights);
  /// Does the same, and writes the numbers of the places whose window has to be looked at into
  /// `chosen`, in ascending order. These are not the places out of range, nor those whose least
  /// window has no return or only returns that hide them.
  /// @return how many were chosen
  std::size_t (*choose)(const SightGrid& grid, const SightPlaces& places,
                        const SightWindows& windows, const Sights& sights, std::uint32_t* chosen);
};

/// The kernels for the best instruction set that this processor has.
SightKernels best_sight_kernels();

}  // namespace raymoval::raymoval_plus_method::kernels
