// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// Static, dynamic or undecided, from the numbers of scans that saw through and that agree.
void decide_voxels(EvidenceMap& map, const RaymovalPlusParameters& parameters);

/// Each voxel takes the majority of the decided voxels within `vote_radius` cells (Chebyshev).
void vote(EvidenceMap& map, const RaymovalPlusParameters& parameters, int threads);

}  // namespace raymoval
