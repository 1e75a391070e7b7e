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

/// Returns of a scan by bin: of each bin two numbers, row by row. The first is the range of the
/// nearest return, the second that of the farthest with a minus before it, so that the least of
/// either holds for several bins. Both are +infinity where there is no return.
struct SightImage {
  int columns = 0;
  int rows = 0;
  int margin = 0;  ///< Bins before column 0 and after the last one, which repeat the other end.
  /// Rows from here on are above the highest beam: nothing is seen through there.
  int first_unseen_row = 0;

  [[nodiscard]] int stride() const { return columns + 2 * margin; }
};

/// How a place is tested against the returns around it.
struct SightTest {
  const float* bins = nullptr;
  /// The least of the window around each bin. Where no return of it lies in the bin's row or below,
  /// and above the highest beam, the second number has no minus.
  const float* windows = nullptr;
  const float* row_windows = nullptr;  ///< The least of the bins to either side, in the same row.
  int wide = 0, high = 0;              ///< Half sizes of the least window, bins.
  float least_range = 0.0F;            ///< Nearer places have larger windows.
  std::array<float, 2> agree{}, occluded{};  ///< Metres at range 0, and for each metre of range.
  float range_min = 0.0F, range_max = 0.0F;  ///< Places beyond are not chosen.
};

/// What a scan says of a place: `kOccluded` where a return hides it, `kNothing` where none does.
enum class Sighted : std::int32_t { kUnsure, kAgree, kFree, kOccluded, kNothing };

/// The places that a scan may agree with or see through. Each array has room for `kMostLanes` more
/// than there are.
struct ChosenSights {
  std::uint32_t* place = nullptr;   ///< Its number, ascending.
  std::int32_t* sighted = nullptr;  ///< A `Sighted`. Where unsure, each bin has to be looked at.
  Sights sights;
};

struct SightKernels {
  /// Finds the range and the bin of each place.
  void (*locate)(const SightGrid& grid, const SightPlaces& places, const Sights& sights);
  /// Finds the places that a scan may agree with or see through. These are not the places out of
  /// range, nor those whose least window has no return or only returns that hide them.
  /// @return how many there are
  std::size_t (*choose)(const SightGrid& grid, const SightPlaces& places, const SightImage& image,
                        const SightTest& test, const ChosenSights& chosen);
  /// Looks at each bin of the windows of places that are unsure. Only those nearer than the test's
  /// least range are unsure afterwards.
  /// @param unsure places in the arrays of `chosen`, `count` of them and room for `kMostLanes` more
  void (*settle)(const SightImage& image, const SightTest& test, const std::uint32_t* unsure,
                 std::size_t count, const ChosenSights& chosen);
  /// Fills the least of `wide` bins to either side of each bin, and from that, of `high` rows below
  /// and above it; `windows` as in `SightTest`. Margins are not filled.
  void (*fill_windows)(const SightImage& image, int wide, int high, const float* bins,
                       float* row_windows, float* windows);
};

/// The kernels for the best instruction set that this processor has.
SightKernels best_sight_kernels();

}  // namespace raymoval::raymoval_plus_method::kernels
