// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/common/scan_cells.h"
#include "methods/raymoval_plus/evidence/evidence_maps.h"
#include "methods/raymoval_plus/terrain/terrain.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// A scan, and where its points are in the terrain and in the map. The steps fill it one after the
/// other; it is used again for the next scan, since memory that is new costs time.
struct LocatedScan {
  Scan scan;
  ScanCells in_terrain, in_map;
  std::vector<BeamImage::Extension> extensions;
  std::vector<float> height;  ///< Of each point above the ground, metres, or +infinity.
  /// Number among the voxels of what stands, or `EvidenceMap::kNone`, see `has_standing_voxel`.
  std::vector<std::uint32_t> voxel;
  /// Number among the voxels of the ground, or `EvidenceMap::kNone` for what stands, and where no
  /// scan is asked about the ground.
  std::vector<std::uint32_t> ground_voxel;
  std::vector<Verdict> verdict;  ///< Of each point's voxel (steps 4 and 5).

  [[nodiscard]] Eigen::Vector3d world(std::size_t point) const {
    return scan.T_world_sensor * scan.points[point].cast<double>();
  }
  /// Whether a point is in a voxel of what stands. Ground is not, nor is what changed sides, see
  /// `look_up`: it may be high above the ground.
  [[nodiscard]] bool has_standing_voxel(std::size_t point) const {
    return voxel[point] != EvidenceMap::kNone;
  }
};

/// Finds the points' cells in the terrain, if there is to be one.
void find_terrain_cells(const Terrain& terrain, const Parameters& parameters,
                        const RunContext& context, LocatedScan& scan);
/// Finds the points' heights above the ground, given their cells in the terrain.
void find_heights(const Terrain& terrain, const Parameters& parameters, const RunContext& context,
                  LocatedScan& scan);
/// The same, and finds their cells in the map.
void find_heights_and_cells(const Terrain& terrain, const EvidenceMaps& maps,
                            const Parameters& parameters, const RunContext& context,
                            LocatedScan& scan);
/// Step 2: adds the points to the maps. Fills `voxel` and `ground_voxel`.
void add_to_maps(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                 EvidenceMaps& maps);
/// Step 2 for a scan that was added before its heights were found anew: adds the points that were
/// ground and are not, and the other way round, and forgets the voxels that were theirs.
void correct_voxels(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                    EvidenceMaps& maps);
/// Looks the points up in maps that have all of them. Fills `voxel`, `ground_voxel` and `verdict`.
/// A point has no voxel, and is static, if it was ground when its scan was added and is not after
/// the terrain was found anew, or the other way round.
void look_up(const EvidenceMaps& maps, const Parameters& parameters, const RunContext& context,
             LocatedScan& scan);
/// Fills `verdict`, given `voxel` and `ground_voxel`.
void look_up_verdicts(const EvidenceMaps& maps, const RunContext& context, LocatedScan& scan);

}  // namespace raymoval::raymoval_plus_method
