// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// Step 5: the decided voxels within `vote_radius` cells (Chebyshev distance) of a voxel, itself
/// included, vote on its verdict. All voxels of these blocks get one.
void vote(const std::vector<std::uint32_t>& blocks, const Parameters& parameters,
          const RunContext& context, EvidenceMap& map);
/// Step 5 for the whole map.
void vote(const Parameters& parameters, const RunContext& context, EvidenceMap& map);

/// The blocks that hold points of a scan, in order of their first points.
/// @param voxels of the points, or `EvidenceMap::kNone`
std::vector<std::uint32_t> blocks_of(const std::vector<std::uint32_t>& voxels,
                                     const EvidenceMap& map);

}  // namespace raymoval::raymoval_plus_method
