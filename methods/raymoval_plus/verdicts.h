// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// Each voxel of these blocks takes the majority of the decided voxels within `vote_radius` cells
/// (Chebyshev).
void vote(const std::vector<std::uint32_t>& blocks, const RaymovalPlusParameters& parameters,
          int threads, EvidenceMap& map);

}  // namespace raymoval
