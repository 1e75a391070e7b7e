// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <array>
#include <catch2/catch.hpp>

#include "tests/methods/raymoval_plus/map_points.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;
using namespace raymoval::raymoval_plus_method;

namespace {

using Passes = std::array<std::uint32_t, VoxelEvidence::kPasses>;

VoxelEvidence counts(std::uint16_t hits, std::uint16_t passes, std::uint16_t open = 0) {
  return {.hits = hits, .passes_before = passes, .open_after = open};
}

/// The image of a scan with one return `range` metres ahead of the sensor.
BeamImage image_of_return(float range) {
  Scan scan;
  scan.points.emplace_back(range, 0.02F, 0.02F);
  BeamImage image(Scanner{}.model(), Parameters{});
  image.fill(scan);
  return image;
}

}  // namespace

TEST_CASE("passes count before the first hit of a voxel and after the last one") {
  const VoxelEvidence evidence = evidence_of("ppo.hpoh.po", 70'000);
  CHECK(evidence.hits == 2);
  CHECK(evidence.first_hit == 70'004);
  CHECK(evidence.last_hit == 70'007);
  CHECK(evidence.passes_before == 2);
  CHECK(evidence.open_before == 1);
  CHECK(evidence.passes_after == 1);  // Scan 5 passed between two hits.
  CHECK(evidence.open_after == 1);
  CHECK(evidence.first_passes == Passes{70'000, 70'001, 0, 0});
  CHECK(evidence.last_passes[0] == 70'009);
}

TEST_CASE("the first passes before and the last passes after are kept") {
  VoxelEvidence evidence = evidence_of("pppppphpppppp");
  CHECK(evidence.passes_before == 6);
  CHECK(evidence.first_passes == Passes{0, 1, 2, 3});
  CHECK(evidence.passes_after == 6);
  CHECK(evidence.last_passes == Passes{11, 12, 9, 10});  // A ring: of 7 to 12, the last four.
  add_observation(Observation::kHit, 13, evidence);
  add_observation(Observation::kPassed, 14, evidence);
  CHECK(evidence.passes_after == 1);
  CHECK(evidence.last_passes[0] == 14);
}

TEST_CASE("the contradiction of a voxel is the share of its scans that pass outside its hits") {
  CHECK(contradiction(counts(0, 0)) == 0.0F);
  CHECK(contradiction(counts(0, 1)) == Approx(0.5));             // 1 of 1 + 0 + 1.
  CHECK(contradiction(counts(10, 1)) == Approx(1.0 / 12.0));     // 1 of 1 + 10 + 1.
  CHECK(contradiction(counts(500, 12)) == Approx(12.0 / 23.0));  // Hits count up to ten.
  CHECK(contradiction(evidence_of("pphhppp")) == Approx(5.0 / 8.0));
  CHECK(contradiction(counts(3, 1, 2)) == Approx(3.0 / 7.0));  // What is open counts, ...
  CHECK(contradiction(counts(4, 1, 2)) == Approx(1.0 / 6.0));  // ... unless four scans hit it.
}

TEST_CASE("a voxel is firm if ten scans hit it and less than a tenth contradicts it") {
  CHECK(is_firm(counts(10, 0)));
  CHECK(is_firm(counts(10, 1)));        // 1 / 12.
  CHECK_FALSE(is_firm(counts(10, 2)));  // 2 / 13.
  CHECK_FALSE(is_firm(counts(9, 0)));
}

TEST_CASE("a voxel is dynamic from a contradiction on, and static from two hits on") {
  Parameters parameters;
  CHECK(decide(counts(0, 0), parameters) == Verdict::kUndecided);
  CHECK(decide(counts(1, 0), parameters) == Verdict::kUndecided);
  CHECK(decide(counts(2, 0), parameters) == Verdict::kStatic);
  CHECK(decide(counts(2, 2), parameters) == Verdict::kStatic);   // 2 of 5.
  CHECK(decide(counts(2, 3), parameters) == Verdict::kDynamic);  // 3 of 6.
  CHECK(decide(counts(0, 1), parameters) == Verdict::kDynamic);
  parameters.voxel_contradiction = 0.51;
  CHECK(decide(counts(2, 3), parameters) == Verdict::kStatic);
  parameters.voxel_contradiction =
      find_parameter("raymoval_plus", parameter_table().specs(), "voxel_contradiction")
          .notes.minimum;
  CHECK(decide(counts(0, 0), parameters) == Verdict::kUndecided);  // However little is asked for.
}

TEST_CASE("every voxel in range is tested against each scan, and decided on") {
  // Voxels 5, 10 and 15 m ahead, one to the side. The scans have a return at 10 m.
  MapPoints points;
  EvidenceMap& map = points.map;
  const auto front = points.add({5.02, 0.02, 0.02}), hit = points.add({10.02, 0.02, 0.02});
  const auto behind = points.add({15.02, 0.02, 0.02}), aside = points.add({0.0, 9.0, 0.0});
  const WhenToDecide when = GENERATE(WhenToDecide::kNow, WhenToDecide::kLater);
  for (std::size_t scan = 4; scan < 6; ++scan) {
    const BeamImage image = image_of_return(10.0F);
    const PosedImage posed{&image, Eigen::Vector3d::Zero(), scan};
    add_evidence(std::span(&posed, 1), Parameters{}, when, RunContext{}, map);
  }
  if (when == WhenToDecide::kLater) {
    CHECK(map.decision(front) == Verdict::kUndecided);
    decide_all(Parameters{}, RunContext{}, map);
  }
  CHECK(map.evidence(front).passes_before == 2);
  CHECK(map.evidence(front).first_passes == Passes{4, 5, 0, 0});
  CHECK(map.decision(front) == Verdict::kDynamic);
  CHECK(map.evidence(hit).hits == 2);
  CHECK(map.evidence(hit).first_hit == 4);
  CHECK(map.evidence(hit).last_hit == 5);
  CHECK(map.decision(hit) == Verdict::kStatic);
  for (const auto unseen : {behind, aside}) {
    CHECK(map.evidence(unseen).passes_before + map.evidence(unseen).hits == 0);
    CHECK(map.decision(unseen) == Verdict::kUndecided);
  }
}

TEST_CASE("a new voxel gets its evidence from the earlier scans that are kept") {
  // Of scans 0 to 4, the last two are kept: 3 and 4. Scans 0 to 2 would hit the voxel at 5 m.
  Parameters parameters;
  parameters.history_scans = 2;
  EarlierScans earlier(parameters);
  std::size_t scan = 0;
  for (const float range : {5.0F, 5.0F, 5.0F, 10.0F, 12.0F}) {
    earlier.keep(image_of_return(range), scan++);
  }
  MapPoints points;
  EvidenceMap& map = points.map;
  const auto known = points.add({5.02, 0.02, 0.02}), fresh = points.add({5.22, 0.02, 0.02});
  const auto hit = points.add({10.02, 0.02, 0.02});
  earlier.add_evidence(fresh, {0.3, 0.0, 0.0}, WhenToDecide::kNow, RunContext{}, map);
  CHECK(map.evidence(known).passes_before == 0);
  CHECK(map.evidence(fresh).hits == 0);
  CHECK(map.evidence(fresh).first_passes == Passes{3, 4, 0, 0});
  CHECK(map.decision(fresh) == Verdict::kDynamic);
  CHECK(map.evidence(hit).hits == 1);  // By scan 3; scan 4 passes afterwards.
  CHECK(map.evidence(hit).first_hit == 3);
  CHECK(map.evidence(hit).last_passes[0] == 4);
}

}  // namespace raymoval::raymoval_plus_test
