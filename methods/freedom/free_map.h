// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "methods/common/scan_grid.h"
#include "methods/freedom/scan_map.h"
#include "methods/remover.h"

namespace raymoval::freedom_method {

/// One bit for each voxel of a block of 8 x 8 x 8: word x, byte y, bit z.
using BlockBits = std::array<std::uint64_t, 8>;

/// How often the voxels of a block were passed and hit, 1.2 KiB.
struct FreeBlock {
  std::array<std::uint8_t, 512> passes{};  ///< Scans that passed since the last hit.
  std::array<std::uint8_t, 512> hits{};    ///< Scans that hit since the last pass.
  BlockBits is_ready{};                    ///< Passed often enough to be free.
  BlockBits is_free{};
};

/// First part of step 4: marks the voxels of a scan as hit in `grid` (empty before), and as free
/// those that rays pass on their way to the voxels' mean points and to `hole_ends`. A ray stops
/// before a voxel that the scan hits, and before the voxel that it ends in.
/// @param hole_ends ends of rays without a return, sensor frame, metres
/// @param context is asked now and then whether to stop
/// @throws DataError for rays that cross too many voxels; Cancelled
/// @note voxels which a ray crosses for less than a millionth of a voxel just before the one that
/// it ends in are not marked
void cast_rays(const Scan& scan, const ScanMap& voxels,
               const std::vector<Eigen::Vector3d>& hole_ends, const Parameters& parameters,
               scan_grid::ScanGrid& grid, const RunContext& context = {});

/// Free space as all scans so far know it. Counts stop at 255, the largest threshold.
class FreeMap {
 public:
  explicit FreeMap(const Parameters& parameters) : p_(parameters) {}

  /// First part of step 2: counts the voxels of a scan as hit. Those that are free become
  /// conservative; those hit too often, and their neighbours, are free no more.
  void take_hits(ScanMap& scan);
  /// Second part of step 4: counts the voxels that rays of a scan pass. @return the newly free ones
  [[nodiscard]] std::vector<VoxelIndex> take_passes(const scan_grid::ScanGrid& rays);

  [[nodiscard]] bool is_free(const VoxelIndex& voxel) const;

 private:
  /// Voxels of a block that may become free.
  struct Candidates {
    VoxelIndex block;
    BlockBits voxels;
  };

  void revert(const VoxelIndex& voxel);
  void pass(const VoxelIndex& block, const BlockBits& passed, std::vector<Candidates>& candidates);
  [[nodiscard]] BlockBits all_neighbours_ready(const VoxelIndex& block) const;

  Parameters p_;
  SparseBlocks<FreeBlock> blocks_;
};

}  // namespace raymoval::freedom_method
