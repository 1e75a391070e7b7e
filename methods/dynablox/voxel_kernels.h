// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

/// Loops over the voxels of a layer, compiled for each instruction set.
namespace raymoval::dynablox_method::kernels {

/// What all voxels have in common while one scan is integrated.
struct Integration {
  const float* image = nullptr;  ///< As `RangeImage` stores it.
  int columns = 0, rows = 0;
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F, elevation_min = 0.0F;
  float min_range = 0.0F, max_range = 0.0F, truncation = 0.0F, max_weight = 0.0F;
  /// From a voxel's centre to the next one's along x and y, sensor frame, metres.
  std::array<float, 3> along_x{}, along_y{};
};

/// A layer to integrate the scan into.
struct LayerFields {
  std::array<float, 3> first{};  ///< The centre of its first voxel in the sensor frame, metres.
  float* distance = nullptr;
  std::uint16_t* weight = nullptr;
};

/// What all voxels have in common when it is seen which were occupied.
struct Sweep {
  float occupied_below = 0.0F;
  std::int32_t scan = 0;
  std::int32_t temporal_buffer = 0, burn_in = 0, frames_to_reset = 0;
};

/// A layer to sweep: what it holds, and bits of its rows.
struct SweptLayer {
  const float* distance = nullptr;
  const std::uint16_t* weight = nullptr;
  std::int32_t* last_occupied = nullptr;
  std::uint16_t* occupied_scans = nullptr;
  const std::uint16_t* hit = nullptr;  ///< Null where the scan has no point in the block.
  std::uint16_t* settled = nullptr;    ///< Gets which are settled.
  std::uint16_t* lasting = nullptr;    ///< Gets which are occupied for long enough to be reset.
};

struct Kernels {
  /// @return whether any voxel was updated
  bool (*integrate)(const Integration& scan, const LayerFields& layer);
  void (*sweep)(const Sweep& scan, const SweptLayer& layer);
  /// Only says which voxels are settled.
  void (*settle)(const Sweep& scan, const SweptLayer& layer);
};

/// The kernels for the best set that this processor has.
Kernels best_kernels();

}  // namespace raymoval::dynablox_method::kernels
