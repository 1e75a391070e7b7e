// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Loops over the points of a scan, compiled for each instruction set. `angular_grid`, `voxel_runs`
/// and `consistency` are the way to them.
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

struct ScanKernels {
  std::size_t lanes;  ///< Points handled at a time.
  /// Points begin .. end - 1, a multiple of `lanes`. @return whether there is a close call among
  /// them
  bool (*project)(const Projection& job, std::size_t begin, std::size_t end);
  /// The same. @return false if an index is beyond the limit
  bool (*voxelise)(const Voxelisation& job, std::size_t begin, std::size_t end);
  /// @return how many runs begin with one of the points
  std::size_t (*find_runs)(const RunSearch& job);
  /// Points begin .. end - 1, a multiple of `lanes`.
  void (*check)(const ConsistencyCheck& job, std::size_t begin, std::size_t end);
};

/// The kernels of the best instruction set that this processor has.
ScanKernels best_scan_kernels();

}  // namespace raymoval::raymoval_method::kernels
