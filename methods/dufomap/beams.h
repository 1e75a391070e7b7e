// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/scan_grid.h"
#include "methods/common/sparse_blocks.h"
#include "methods/dufomap/dufomap.h"
#include "methods/remover.h"

namespace raymoval::dufomap_method {

using namespace scan_grid;  // Its blocks and columns.

/// Walks a line from voxel to voxel (Amanatides and Woo 1987). Lengths in voxels.
class CellWalk {
 public:
  /// @param direction of unit length, or zero: then there is no next voxel
  /// @param cell a voxel on the line, at which the walk starts
  CellWalk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, const VoxelIndex& cell)
      : cell_(cell) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (direction[k] == 0.0) continue;
      step_[axis] = direction[k] > 0.0 ? 1 : -1;
      next_[axis] = (cell[k] + (direction[k] > 0.0 ? 1 : 0) - origin[k]) / direction[k];
      delta_[axis] = 1.0 / std::abs(direction[k]);
    }
  }

  [[nodiscard]] const VoxelIndex& cell() const { return cell_; }
  /// Distance from the origin at which the line enters the next voxel.
  [[nodiscard]] double next_distance() const { return next_[next_axis()]; }
  /// Goes to the next voxel. @return the axis of the step
  std::size_t advance() {
    const std::size_t axis = next_axis();
    cell_[static_cast<Eigen::Index>(axis)] += step_[axis];
    next_[axis] += delta_[axis];
    return axis;
  }

 private:
  /// Through an edge: x before y before z.
  [[nodiscard]] std::size_t next_axis() const {
    const std::size_t level = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[level] ? 2 : level;
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();
  VoxelIndex cell_;
  std::array<int, 3> step_{};
  std::array<double, 3> next_{kNever, kNever, kNever}, delta_{kNever, kNever, kNever};
};

/// Voxel of each point of `scan`. @throws DataError beyond the lattice.
std::vector<VoxelIndex> voxels_of(const Scan& scan, double voxel_size);

/// Step 1: the voxels that hold a point of `scan` not nearer than `minimum_range`, each once,
/// ordered by direction around the sensor, so that neighbours in the list pass through the same
/// voxels.
/// @param voxels of each point; @param grid empty before and after
std::vector<VoxelIndex> beam_ends(const Scan& scan, const std::vector<VoxelIndex>& voxels,
                                  const Parameters& parameters, ScanGrid& grid);

/// Steps 1-3 for one scan: fills `grid` (empty before) with the hits and free voxels of the scan.
/// @param context is checked for a cancel now and then
/// @throws DataError for a beam of more than 131,072 voxels; Cancelled
void cast_beams(const Scan& scan, const std::vector<VoxelIndex>& ends, const Parameters& parameters,
                ScanGrid& grid, const RunContext& context = {});

/// Void voxels of a block, a word for each column.
using VoidBits = std::array<std::uint64_t, kColumns>;

/// Void voxels of one scan by block.
using ScanVoids = std::vector<std::pair<VoxelIndex, VoidBits>>;

/// Step 4: voxels that are not hit and whose (2 d_p + 1)^3 neighbourhood is all free.
/// @param inflation d_p, voxels, at most a block's side
void find_voids(const ScanGrid& grid, int inflation, ScanVoids& voids);

/// Step 5: the voids of all scans so far, 8 KiB per block of 32 x 32 x 64 voxels.
class VoidMap {
 public:
  void add(const ScanVoids& voids);
  /// 1 for each voxel that is a void.
  [[nodiscard]] std::vector<std::uint8_t> contain(const std::vector<VoxelIndex>& voxels) const;

 private:
  SparseBlocks<VoidBits> blocks_;
};

}  // namespace raymoval::dufomap_method
