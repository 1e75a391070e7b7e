// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_map.h"
#include "methods/raymoval_plus/terrain/terrain.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// A scan and where its points are in the world.
struct WorldScan {
  Scan scan;
  std::vector<Eigen::Vector3d> points;  ///< World frame, metres.
};
WorldScan to_world(Scan scan, const RunContext& context);

/// A scan whose points were looked up in the terrain and in the map.
struct LocatedScan : WorldScan {
  std::vector<float> height;         ///< Of each point above the ground, metres, or +infinity.
  std::vector<std::uint32_t> voxel;  ///< Number in the map, or `EvidenceMap::kNone` for ground.
};
/// Step 2: adds the points that are not ground to the map.
LocatedScan add_to_map(WorldScan world, const Terrain& terrain, const Parameters& parameters,
                       const RunContext& context, EvidenceMap& map);
/// Looks a scan up in a terrain and a map that are finished.
LocatedScan locate(WorldScan world, const Terrain& terrain, const EvidenceMap& map,
                   const Parameters& parameters, const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
