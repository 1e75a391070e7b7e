// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/common/scan_grid.h"
#include "methods/freedom/scan_map.h"
#include "methods/remover.h"

namespace raymoval::freedom_method {

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

}  // namespace raymoval::freedom_method
