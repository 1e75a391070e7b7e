// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Loops over the bins of an image, compiled for each instruction set. `map_reference`,
/// `consistency` and `wanted_bins` are the way to them.
namespace raymoval::raymoval_method::kernels {

/// One row of eqs 8-9 for windows of 3 x 3.
struct WindowRow {
  std::array<const float*, 3> values{};  ///< The rows above, here and below.
  const float* wanted = nullptr;         ///< Bins with a finite value here are wanted.
  int columns = 0;
  /// Ranks of two percentiles among 1 .. 9 finite values.
  std::array<std::array<int, 10>, 2> ranks{};
  std::array<float*, 2> results{};  ///< Null where a percentile is not asked for.
  float* scratch = nullptr;         ///< 3 x (columns + 2) numbers.
};

/// Smallest value of a window around each bin.
struct WindowMinimum {
  const float* values = nullptr;
  float* result = nullptr;
  int columns = 0, rows = 0;
  int azimuth_radius = 0, elevation_radius = 0;
  float* scratch = nullptr;  ///< `lanes` x (rows + 2 elevation_radius) numbers, aligned.
};

/// What is not told: the neighbourhood reaches over the end of a row.
inline constexpr float kUnknown = -1.0F;

/// The search for bins that may be seen through, from the nearest return of the neighbourhood, the
/// first hit and the map reference of each bin.
struct SuspectSearch {
  const float* own = nullptr;  ///< The bin's own return; infinite if it has none.
  int columns = 0, rows = 0;
  int azimuth_radius = 0, elevation_radius = 0;  ///< Of the neighbourhood.
  const float* first_hit = nullptr;
  const float* reference = nullptr;
  float tau0 = 0.0F, tau1 = 0.0F;  ///< A little less than the margin's.
};

struct ImageKernels {
  int lanes;  ///< Bins handled at a time; a row needs at least so many.
  void (*percentiles)(const WindowRow& job);
  /// The columns `first` .. `first` + lanes - 1, which lie within the row; the first `skip` of them
  /// are not written.
  void (*minimum)(const WindowMinimum& job, int first, int skip);
  /// One bit for each of 16 bins from `bin` on. It may be set for a bin too many, never for one too
  /// few. Where it is set, `nearest` gets the nearest return of the neighbourhood, or `kUnknown`.
  std::uint32_t (*suspects)(const SuspectSearch& job, std::size_t bin, float* nearest);
  /// One bit for each of `count` values, in words of 64: whether it is finite. The last word's
  /// other bits are 0.
  void (*finite)(const float* values, std::size_t count, std::uint64_t* words);
};

/// The kernels of the best instruction set that this processor has.
ImageKernels best_image_kernels();

}  // namespace raymoval::raymoval_method::kernels
