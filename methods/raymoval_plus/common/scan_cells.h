// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"

namespace raymoval::raymoval_plus_method {

/// The number of points that one thread takes at a time: enough that starting a task costs little,
/// and few enough that a scan of 120,000 points makes 15 tasks. It changes no answer.
inline constexpr std::size_t kPointsATask = 8192;

/// So many points are taken through each step of a loop before the next step, so that the memory
/// that they need comes in meanwhile. It changes no answer.
inline constexpr std::size_t kPointsAtOnce = 64;

/// The cells of a scan's points in some lattice of the world; one number for each point.
struct ScanCells {
  std::vector<std::int32_t> x, y, z;
  /// Where the points are in their cells: 256 parts along each axis, in bytes, those of x lowest.
  std::vector<std::uint32_t> parts;
  std::vector<float> height;  ///< z of the world points, metres.

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] VoxelIndex operator[](std::size_t point) const {
    return {x[point], y[point], z[point]};
  }
};

/// Of `ScanCells::parts`, those along z.
inline std::uint32_t upward(std::uint32_t parts) {
  return parts >> 16U & 0xFFU;
}

/// What `find_cells` finds beside the cells. An array that is not named is left as it is.
enum class BesideCells : std::uint8_t { kParts, kPartsAndHeight };

/// Finds the cells of a scan's points.
/// @param cells_a_metre along each axis
/// @throws DataError if a point lies beyond the lattice, or is not finite
void find_cells(const Scan& scan, const Eigen::Vector3d& cells_a_metre, BesideCells beside,
                int threads, ScanCells& cells);

}  // namespace raymoval::raymoval_plus_method
