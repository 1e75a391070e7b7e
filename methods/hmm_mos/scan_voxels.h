// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "core/scan/scan.h"
#include "methods/common/column_grid.h"
#include "methods/hmm_mos/lattice.h"
#include "methods/remover.h"

namespace raymoval::hmm_mos_method {

using namespace column_blocks;

/// What one scan says of a column of voxels. Each voxel has a bit, the lowest voxel the lowest bit.
struct Column {
  std::uint64_t observed = 0;  ///< A ray passes or ends here.
  std::uint64_t occupied = 0;  ///< A ray ends here.
  std::uint64_t appeared = 0;  ///< Occupied, and free before: its state changes with this scan.
};

using ScanBlock = ColumnBlock<Column>;

/// The voxels of one scan within range of its sensor.
class ScanGrid : public ColumnGrid<Column> {
 public:
  ScanGrid()
      : ColumnGrid("hmm_mos", "Set a smaller hmm_mos.max_range, or a larger hmm_mos.voxel_size.") {}

  /// The column of a voxel; an empty one where the scan has nothing.
  [[nodiscard]] const Column& column_if(const VoxelIndex& voxel) const {
    static constexpr Column kEmpty{};
    const ScanBlock* found = find(block_of(voxel));
    return found == nullptr ? kEmpty : found->columns[column_of(voxel)];
  }
  [[nodiscard]] bool is_occupied(const VoxelIndex& voxel) const {
    return (column_if(voxel).occupied & bit_of(voxel)) != 0;
  }
};

/// Whether a point is far enough from its sensor to count. One that is not finite is not.
inline bool counts(const Eigen::Vector3f& point, const Parameters& parameters) {
  return point.cast<double>().norm() > parameters.min_range;
}

/// Steps 1 and 2: what of a scan is occupied, and what it observes on its rays.
/// @param grid is overwritten
/// @throws DataError for points beyond the common lattice; Cancelled
void find_voxels(const Scan& scan, const Parameters& parameters, const RunContext& context,
                 ScanGrid& grid);

}  // namespace raymoval::hmm_mos_method
