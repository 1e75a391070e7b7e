// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/scan/sensor_model.h"
#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_map.h"

namespace raymoval::raymoval_plus_method {

/// Step 2: what stands on the ground, and what was taken for ground, each in voxels of its own.
/// Neither has a say about the other: the road stays under what was driven away from it, and what
/// few beams saw of a vehicle goes although it was taken for the road.
struct EvidenceMaps {
  /// An edge of a ground voxel is so many of the others': ground is wide, and seen as well at
  /// coarser places.
  static constexpr int kGroundEdges = 2;

  /// @param sensor whose scans the maps are made of
  explicit EvidenceMaps(const Parameters& parameters, const SensorModel& sensor = {})
      : standing(parameters.voxel_size),
        ground(kGroundEdges * parameters.voxel_size, false),
        elevation_step(static_cast<float>(sensor.elevation_step)) {}

  [[nodiscard]] std::array<EvidenceMap*, 2> both() { return {&standing, &ground}; }
  /// The numbers of their voxels.
  [[nodiscard]] std::array<std::size_t, 2> sizes() const {
    return {standing.size(), ground.size()};
  }

  EvidenceMap standing, ground;
  float elevation_step;  ///< Between neighbouring rows of the sensor, radians; 0: unknown.
};

/// The cell of a ground voxel that a cell of the others lies in.
inline VoxelIndex ground_cell(const VoxelIndex& cell) {
  return {cell.x() >> 1, cell.y() >> 1, cell.z() >> 1};
}

/// Where a point is in its ground cell, see `ScanCells::parts`.
/// @param cell, parts the point's among the others
inline std::uint32_t ground_parts(const VoxelIndex& cell, std::uint32_t parts) {
  const auto upper_half = [](int index) { return static_cast<std::uint32_t>(index & 1); };
  return (parts >> 1U & 0x7F7F7FU) | upper_half(cell.x()) << 7U | upper_half(cell.y()) << 15U |
         upper_half(cell.z()) << 23U;
}

}  // namespace raymoval::raymoval_plus_method
