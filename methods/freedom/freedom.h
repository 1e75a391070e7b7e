// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/freedom/parameters.h"
#include "methods/method_entry.h"

namespace raymoval {
namespace freedom_method {

/// C. Li et al.: "FreeDOM: Online Dynamic Object Removal Framework for Static Map Construction
/// Based on Conservative Free Space Estimation", RA-L 2025. Voxels (0.4 m) are free or not;
/// sub-voxels (0.1 m) keep one point each, with the scan it is of and a level. Per scan:
///  1. Scan map: the points in range in voxels.
///  2. Scan removal: what is hit in free space is conservative, and levels grow around it in the
///     scan. Free space that is hit scan after scan is free no more.
///  3. Raycast enhancement: ends of rays without a return, where a hole of the depth image is open
///     to the top.
///  4. Free space: rays count the voxels that they pass. A voxel that was passed often enough, as
///     were its neighbours, is free.
///  5. Map removal: points in newly free voxels are conservative, and levels grow around them among
///     points of the same scan.
///  6. Integration: a point goes into its sub-voxel unless one of the same or a lower level is
///     there.
///  7. The map is what is static after the last scan; a point goes if its sub-voxel is not.
/// Decisions and deviations from the public program: `notes` of the entry.
std::unique_ptr<Remover> make_freedom(const Parameters& parameters);

}  // namespace freedom_method

MethodEntry freedom_entry();

}  // namespace raymoval
