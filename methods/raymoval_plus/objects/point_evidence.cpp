// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/point_evidence.h"

#include "methods/raymoval_plus/evidence/evidence.h"

#include <algorithm>
#include <cstdint>

namespace raymoval::raymoval_plus_method {
namespace {

/// Of a point that belongs to no object.
constexpr float kNoObject = -1.0F;

/// For each point of a scan the share of its object's points that are dynamic, or `kNoObject`.
std::vector<float> object_shares(const SegmentedScan& scan) {
  std::vector<float> shares(scan.scan.size(), kNoObject);
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const Cluster& cluster = scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])];
    shares[scan.high_points[i]] = static_cast<float>(cluster.evidence.dynamic) /
                                  static_cast<float>(std::max(cluster.points, 1));
  }
  return shares;
}

/// The contradiction of a point's voxel, but 0 for ground that stays.
float own_share(const LocatedScan& scan, std::size_t k, const EvidenceMaps& maps) {
  if (scan.has_standing_voxel(k)) {
    return contradiction(maps.standing.evidence(scan.voxel[k]));
  }
  if (scan.verdict[k] != Verdict::kDynamic) return 0.0F;
  return contradiction(maps.ground.evidence(scan.ground_voxel[k]));
}

}  // namespace

std::vector<float> evidence_of_points(const SegmentedScan& scan, const Verdicts& decided,
                                      const EvidenceMaps& maps) {
  std::vector<float> evidence = object_shares(scan);
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    const float own = own_share(scan, k, maps);
    const float object = evidence[k] == kNoObject ? own : evidence[k];
    const float verdict = decided[k] == Verdict::kDynamic ? 1.0F : 0.0F;
    evidence[k] = 0.5F * verdict + 0.25F * (own + object);
  }
  return evidence;
}

}  // namespace raymoval::raymoval_plus_method
