// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/removert/parameters.h"

namespace raymoval {

/// The method of "Remove, then Revert: Static Point cloud Map Construction using Multiresolution
/// Range Images" (Kim and Kim, IROS 2020), written from its description; nothing of the public
/// code, whose licence forbids commercial use, is in it.
///
/// What was decided where the paper's programs disagree or are silent:
/// - The difference is signed by default; the public code's absolute value also removes what
///   stands behind a return.
/// - Points outside the vertical field of view are in no pixel; the public code puts them into the
///   border rows. The first and the last half column of a full circle are one column.
/// - Revert is missing in the public code. Here it is that of the author's later lt-mapper: the
///   removed points alone are compared with all scans at coarser pixels, and those not flagged
///   come back.
/// - A single scan is enough to remove a map point; there is no vote unless asked for.
/// - The map's cells lie on the lattice anchored at the world's origin. A point is removed iff its
///   cell is: no nearest neighbour is looked for.
/// - Of the map only centroids are held, at the peak about 75 bytes per cell of `map_voxel`; scans
///   are read once per pass. `map_voxel` = 0 holds every point.
/// - Scans are used as they are: the public code's filter of scans does nothing on data of this
///   size (its cell count overflows).
MethodEntry removert_entry();

/// @throws ConfigurationError for parameters that contradict each other
std::unique_ptr<Remover> make_removert(const RemovertParameters& parameters);

}  // namespace raymoval
