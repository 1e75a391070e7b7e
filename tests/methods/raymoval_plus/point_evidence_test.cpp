// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/point_evidence.h"

#include <catch2/catch.hpp>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

TEST_CASE("free scans make one half where they are as many as are needed, or as a run needs") {
  Parameters parameters;  // 1 + 0.3 x supporting scans must be free, or four in a row.
  parameters.free_constant = 1.0;
  parameters.free_per_agree = 0.3;
  parameters.run_scans = 4;
  CHECK(free_share({0, 0, 0, 0}, parameters) == 0.0F);
  CHECK(free_share({0, 10, 0, 0}, parameters) == 0.0F);
  CHECK(free_share({1, 0, 0, 0}, parameters) == Approx(0.5));     // 1 of the 1 that is needed.
  CHECK(free_share({4, 10, 0, 0}, parameters) == Approx(0.5));    // 4 of 1 + 3.
  CHECK(free_share({12, 10, 0, 0}, parameters) == Approx(0.75));  // 12 / (12 + 4).
  CHECK(free_share({4, 100, 4, 0}, parameters) == Approx(0.5));   // By the run; 4 / 35 by count.
  CHECK(free_share({12, 100, 0, 12}, parameters) == Approx(0.75));
  parameters.run_scans = 0;  // Runs are ignored.
  CHECK(free_share({4, 10, 4, 0}, parameters) == Approx(0.5));
  CHECK(free_share({31, 100, 31, 0}, parameters) == Approx(0.5));  // 31 of 31.
}

TEST_CASE("the verdict counts half, the voxel and the object a quarter each") {
  Parameters parameters;
  EvidenceMaps maps(parameters);
  EvidenceMap& map = maps.standing;
  EvidenceMap::Blocks::Cursor cursor, ground_cursor;
  const std::uint32_t seen_through = map.add({0, 0, 2}, 0, cursor);
  map.evidence(seen_through).free_scans = 3;  // Of 1 that is needed: 3 / 4.
  const std::uint32_t untouched = map.add({9, 9, 2}, 0, cursor);
  const std::uint32_t false_ground = maps.ground.add({5, 5, 0}, 0, ground_cursor);
  maps.ground.evidence(false_ground).free_scans = 4;  // 4 / 5.

  SegmentedScan scan;
  constexpr std::uint32_t kNone = EvidenceMap::kNone;
  scan.scan.points.resize(6);
  scan.voxel = {seen_through, untouched, untouched, kNone, kNone, kNone};
  scan.ground_voxel = {kNone, kNone, kNone, kNone, false_ground, false_ground};
  // Points 0 and 1 are one object of which one point is dynamic; other points are no object.
  scan.high_points = {0, 1};
  scan.cluster_of = {0, 0};
  scan.clusters.resize(1);
  scan.clusters[0].points = 2;
  scan.clusters[0].dynamic = 1;
  const Verdicts decided = {Verdict::kDynamic, Verdict::kStatic,  Verdict::kDynamic,
                            Verdict::kStatic,  Verdict::kDynamic, Verdict::kStatic};
  scan.verdict = decided;

  const std::vector<float> evidence = evidence_of_points(scan, decided, maps, parameters);
  CHECK(evidence[0] == Approx(0.5 + 0.25 * 0.75 + 0.25 * 0.5));
  CHECK(evidence[1] == Approx(0.25 * 0.5));
  CHECK(evidence[2] == Approx(0.5));  // Only the decision supports it.
  CHECK(evidence[3] == 0.0F);         // Ground, which is not evaluated.
  CHECK(evidence[4] == Approx(0.5 + 0.5 * 0.8));
  CHECK(evidence[5] == 0.0F);  // Ground that is kept.
}

}  // namespace raymoval::raymoval_plus_test
