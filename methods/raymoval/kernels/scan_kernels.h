// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Loops over the points of a scan and the bins of an image, compiled for each instruction set.
/// `angular_grid` and `map_reference` are the way to them.
namespace raymoval::raymoval_method::kernels {

/// Eqs 1-3 for points (x y z, x y z, ...) of a scan.
struct Projection {
  const float* points = nullptr;
  double minimum_range = 0.0;
  double elevation_min = 0.0;
  double azimuth_bins_per_radian = 0.0;
  double elevation_bins_per_radian = 0.0;
  int azimuth_bins = 0, elevation_bins = 0;
  float* range = nullptr;
  std::int32_t* bin = nullptr;  ///< kNoBin, kCloseCall or the number.
};
inline constexpr std::int32_t kNoBin = -1;
/// The point is so near to a border that roundings decide: to be computed as the formula says.
inline constexpr std::int32_t kCloseCall = -2;

/// Voxels of points in the world.
struct Voxelisation {
  const float* points = nullptr;
  std::array<double, 9> rotation{};  ///< Row by row.
  std::array<double, 3> translation{};
  double inverse_voxel_size = 0.0;
  double limit = 0.0;                     ///< Largest magnitude of an index.
  std::array<std::int32_t*, 3> voxels{};  ///< x, y and z of the points.
};

/// The search for the runs of points that share a voxel.
struct RunSearch {
  /// x, y and z of the points, behind that of the point before them. Behind the last point its
  /// voxel stands again, up to a multiple of `lanes`.
  std::array<const std::int32_t*, 3> voxels{};
  std::size_t count = 0;          ///< Points.
  std::uint32_t first_point = 0;  ///< The number of the first of them.
  /// The x y z of each run's voxel, and its first point; `lanes` more of each are written over.
  std::int32_t* run_voxels = nullptr;
  std::uint32_t* run_first = nullptr;
};

/// Eq. 11 for points.
struct ConsistencyCheck {
  const float* range = nullptr;       ///< The range of each point, metres.
  const std::int32_t* bin = nullptr;  ///< The bin of each point; below 0 it is in none.
  const float* reference = nullptr;   ///< The map reference of each bin; infinite if it has none.
  double tau0 = 0.0, tau1 = 0.0;
  std::uint8_t* dynamic = nullptr;
};

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
  float* scratch = nullptr;  ///< row_lanes x (rows + 2 elevation_radius) numbers, aligned.
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

struct Kernels {
  std::size_t lanes;  ///< Points handled at a time.
  int row_lanes;      ///< Bins handled at a time; a row needs at least so many.
  /// Points begin .. end - 1, a multiple of `lanes`. @return whether there is a close call among
  /// them
  bool (*project)(const Projection& job, std::size_t begin, std::size_t end);
  /// The same. @return false if an index is beyond the limit
  bool (*voxelise)(const Voxelisation& job, std::size_t begin, std::size_t end);
  /// @return how many runs begin with one of the points
  std::size_t (*find_runs)(const RunSearch& job);
  /// Points begin .. end - 1, a multiple of `lanes`.
  void (*check)(const ConsistencyCheck& job, std::size_t begin, std::size_t end);
  void (*percentiles)(const WindowRow& job);
  /// The columns `first` .. `first` + row_lanes - 1, which lie within the row; the first `skip` of
  /// them are not written.
  void (*minimum)(const WindowMinimum& job, int first, int skip);
  /// One bit for each of 16 bins from `bin` on. It may be set for a bin too many, never for one too
  /// few. Where it is set, `nearest` gets the nearest return of the neighbourhood, or `kUnknown`.
  std::uint32_t (*suspects)(const SuspectSearch& job, std::size_t bin, float* nearest);
  /// One bit for each of `count` values, in words of 64: whether it is finite. The last word's
  /// other bits are 0.
  void (*finite)(const float* values, std::size_t count, std::uint64_t* words);
};

/// The kernels of the best instruction set that this processor has.
Kernels best_kernels();

}  // namespace raymoval::raymoval_method::kernels
