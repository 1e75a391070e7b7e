// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence.h"

#include "core/parallel.h"
#include "methods/raymoval_plus/verdicts.h"

namespace raymoval {

void add_evidence(const RangeImage& image, const Pose& T_world_sensor,
                  const RaymovalPlusParameters& parameters, int threads, EvidenceMap& map) {
  const Pose T_sensor_world = T_world_sensor.inverse(Eigen::Isometry);
  map.settle();
  const auto tiles = map.tiles_near(T_world_sensor.translation(), parameters.evidence_range_max);
  // One tile to a thread at a time: voxels of a block are decided by one thread.
  parallel_for(threads, tiles.size(), 1, [&](std::size_t t) {
    EvidenceMap::Tile& tile = *tiles[t];
    thread_local std::vector<SeenPlace> seen;
    image.see(tile.places, T_sensor_world * Eigen::Translation3d(tile.origin), seen);
    for (const SeenPlace& place : seen) {
      VoxelEvidence& evidence = tile.evidence[place.place];
      const bool is_first = evidence.free_scans == 0 && evidence.agree_scans == 0;
      const Evidence before = decide(evidence, parameters);
      count(place.seen, place.range, parameters, evidence);
      const Evidence now = decide(evidence, parameters);
      // What most scans say changes nothing, and then the voxel itself is not looked at.
      if (is_first || now != before) map.set_decision(tile.voxels[place.place], now);
    }
  });
}

}  // namespace raymoval
