// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/lasting_points.h"

#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// What scans say of the dynamic points of a cluster. Whole numbers give the same sums in any order
/// of the points.
struct DynamicPoints {
  std::int64_t count = 0, agree = 0, first = 0, last = 0;

  void add(const VoxelEvidence& evidence, std::size_t scan) {
    ++count;
    agree += evidence.agree_scans;
    const AgreeingSpan scans = agreeing_span(evidence, scan);
    first += scans.first;
    last += scans.last;
  }
  /// Whether a voxel was there for much longer than these.
  [[nodiscard]] bool are_outlasted_by(const VoxelEvidence& evidence,
                                      const Parameters& parameters) const {
    const std::int64_t settled = parameters.settled_scans;
    return static_cast<double>(evidence.agree_scans * count) >
               parameters.outlast * static_cast<double>(agree) &&
           (evidence.first_agree + settled) * count <= first &&
           (evidence.last_agree - settled) * count >= last;
  }
};

}  // namespace

std::vector<std::uint8_t> lasting_points(const SegmentedScan& scan, const EvidenceMap& map,
                                         const std::vector<std::uint8_t>& may_last,
                                         const Parameters& parameters) {
  std::vector<std::uint8_t> lasting(scan.high_points.size(), 0);
  if (parameters.settled_scans == 0 || parameters.outlast == 0.0) return lasting;
  const auto for_points = [&](auto&& visit) {
    for (std::size_t i = 0; i < lasting.size(); ++i) {
      const std::uint32_t k = scan.high_points[i], voxel = scan.voxel[k];
      const auto cluster = static_cast<std::size_t>(scan.cluster_of[i]);
      if (may_last[cluster] == 0 || voxel == EvidenceMap::kNone) continue;
      visit(i, scan.verdict[k] == Verdict::kDynamic, map.evidence(voxel), cluster);
    }
  };
  std::vector<DynamicPoints> dynamic(scan.clusters.size());
  for_points([&](std::size_t, bool is_dynamic, const VoxelEvidence& evidence, std::size_t cluster) {
    if (is_dynamic) dynamic[cluster].add(evidence, scan.scan.index);
  });
  for_points(
      [&](std::size_t i, bool is_dynamic, const VoxelEvidence& evidence, std::size_t cluster) {
        lasting[i] = !is_dynamic && evidence.agree_scans >= parameters.settled_scans &&
                     is_hardly_seen_through(evidence) &&
                     dynamic[cluster].are_outlasted_by(evidence, parameters);
      });
  return lasting;
}

}  // namespace raymoval::raymoval_plus_method
