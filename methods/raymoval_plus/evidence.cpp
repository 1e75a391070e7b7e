// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence.h"

#include "core/parallel.h"
#include "methods/raymoval_plus/verdicts.h"

namespace raymoval {
namespace {

void count_up(std::uint16_t& count) {
  if (count < 0xFFFFU) ++count;
}

}  // namespace

void count(Seen seen, double distance, const RaymovalPlusParameters& parameters,
           VoxelEvidence& evidence) {
  if (seen == Seen::kAgree) {
    count_up(evidence.agree_scans);
    evidence.trailing_free = 0;
  } else if (seen == Seen::kFree) {
    count_up(evidence.free_scans);
    if (distance > parameters.run_range) return;
    count_up(evidence.trailing_free);
    if (evidence.agree_scans == 0) count_up(evidence.leading_free);
  }
}

void add_evidence(const RangeImage& image, const Pose& T_world_sensor,
                  const RaymovalPlusParameters& parameters, int threads, EvidenceMap& map) {
  const Pose T_sensor_world = T_world_sensor.inverse(Eigen::Isometry);
  map.settle();
  const auto tiles = map.tiles_near(T_world_sensor.translation(), parameters.evidence_range_max);
  // One tile to a thread at a time: voxels of a block are decided by one thread.
  parallel_for(threads, tiles.size(), 1, [&](std::size_t t) {
    const EvidenceMap::Tile& tile = *tiles[t];
    thread_local std::vector<SeenPlace> seen;
    image.see(tile.places, T_sensor_world * Eigen::Translation3d(tile.origin), seen);
    for (const SeenPlace& place : seen) {
      const std::uint32_t voxel = tile.voxels[place.place];
      VoxelEvidence& evidence = map.evidence(voxel);
      count(place.seen, place.range, parameters, evidence);
      map.set_decision(voxel, decide(evidence, parameters));
    }
  });
}

}  // namespace raymoval
