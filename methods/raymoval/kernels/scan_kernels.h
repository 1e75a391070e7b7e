// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Loops over the points of a scan, compiled for each instruction set, that `angular_grid` and
/// `voxel_runs` call.
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
/// The point is so near to a border that rounding decides: it must be computed by the formula.
inline constexpr std::int32_t kCloseCall = -2;

/// Voxels of points in the world.
struct Voxelisation {
  const float* points = nullptr;
  std::array<double, 9> rotation{};  ///< Row by row.
  std::array<double, 3> translation{};
  double inverse_voxel_size = 0.0;
  double limit = 0.0;              ///< Largest absolute index.
  std::int32_t* voxels = nullptr;  ///< x y z of each point.
};

struct ScanKernels {
  std::size_t lanes;  ///< Points handled at a time.
  /// Points begin .. end - 1, a multiple of `lanes`. @return whether there is a close call among
  /// them
  bool (*project)(const Projection& job, std::size_t begin, std::size_t end);
  /// The same. @return false if an index is beyond the limit
  bool (*voxelise)(const Voxelisation& job, std::size_t begin, std::size_t end);
};

/// The kernels of the best instruction set that this processor has.
ScanKernels best_scan_kernels();

}  // namespace raymoval::raymoval_method::kernels
