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
  const Eigen::Vector3d center = T_world_sensor.translation();
  const auto tiles = map.tiles_near(center, parameters.evidence_range_max);
  // One tile to a thread at a time: voxels of a block are decided by one thread.
  parallel_for(threads, tiles.size(), 1, [&](std::size_t t) {
    for (const std::uint32_t voxel : *tiles[t]) {
      const Eigen::Vector3d centroid = map.centroid(voxel);
      const double distance = (centroid - center).norm();
      if (distance > parameters.evidence_range_max || distance < parameters.evidence_range_min) {
        continue;
      }
      const Seen seen = image.test((T_sensor_world * centroid).cast<float>());
      if (seen != Seen::kAgree && seen != Seen::kFree) continue;
      VoxelEvidence& evidence = map.evidence(voxel);
      count(seen, distance, parameters, evidence);
      map.set_decision(voxel, decide(evidence, parameters));
    }
  });
}

}  // namespace raymoval
