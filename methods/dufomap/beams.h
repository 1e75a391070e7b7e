// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "methods/common/scan_grid.h"
#include "methods/dufomap/parameters.h"
#include "methods/remover.h"

namespace raymoval::dufomap_method {

using namespace scan_grid;  // Its blocks and columns.

/// Voxel of each point of `scan`. @throws DataError beyond the lattice.
std::vector<VoxelIndex> voxels_of(const Scan& scan, double voxel_size);

/// Step 1: the voxels that hold a point of `scan` not nearer than `minimum_range`, each once,
/// ordered by direction around the sensor: neighbours on the list see the same voxels.
/// @param voxels of each point; @param grid empty before and after
std::vector<VoxelIndex> beam_ends(const Scan& scan, const std::vector<VoxelIndex>& voxels,
                                  const Parameters& parameters, ScanGrid& grid);

/// Steps 1-3 for one scan: fills `grid` (empty before) with the hits and free voxels of the scan.
/// @param context is asked now and then whether to stop
/// @throws DataError for a beam of more than 131,072 voxels; Cancelled
void cast_beams(const Scan& scan, const std::vector<VoxelIndex>& ends, const Parameters& parameters,
                ScanGrid& grid, const RunContext& context = {});

}  // namespace raymoval::dufomap_method
