// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/methods/raymoval_plus/map_points.h"
#include "tests/methods/toy_world.h"

using namespace raymoval;
using namespace raymoval::raymoval_plus_method;

namespace {

/// The image of a scan with one return `range` metres ahead of the sensor.
RangeImage image_of_return(float range) {
  Scan scan;
  scan.points.emplace_back(range, 0.02F, 0.02F);
  RangeImage image(toy::Scanner{}.model(), Parameters{});
  image.fill(scan);
  return image;
}

}  // namespace

TEST_CASE("scans that see through are weighed against scans that agree") {
  const auto decided = [](std::uint16_t free, std::uint16_t agree, std::uint16_t leading = 0,
                          std::uint16_t trailing = 0) {
    return decide({free, agree, leading, trailing}, Parameters{});
  };
  // Needed: 1 + 0.3 x the scans that agree.
  CHECK(decided(1, 0) == Verdict::kDynamic);
  CHECK(decided(3, 10) == Verdict::kStatic);
  CHECK(decided(4, 10) == Verdict::kDynamic);
  CHECK(decided(0, 1) == Verdict::kUndecided);
  CHECK(decided(0, 2) == Verdict::kStatic);
  // Or four in a row, before the first or after the last scan that agrees.
  CHECK(decided(4, 100, 4, 0) == Verdict::kDynamic);
  CHECK(decided(4, 100, 0, 4) == Verdict::kDynamic);
  CHECK(decided(6, 100, 3, 3) == Verdict::kStatic);
}

TEST_CASE("decisions on many voxels are those of the formula") {
  std::mt19937 random(9);
  const auto count = [&](unsigned most) { return static_cast<std::uint16_t>(random() % most); };
  for (const double constant : {0.0, 1.0, 2.5}) {
    for (const int run_scans : {0, 4}) {
      Parameters parameters;
      parameters.free_constant = constant;
      parameters.run_scans = run_scans;
      const Decisions decided(parameters);
      for (int i = 0; i < 3000; ++i) {
        const VoxelEvidence evidence{count(i % 2 == 0 ? 10 : 200), count(i % 3 == 0 ? 3 : 600),
                                     count(6), count(6)};
        REQUIRE(decided(evidence) == decide(evidence, parameters));
      }
    }
  }
}

TEST_CASE("runs of scans that see through are counted at either end of a voxel's story") {
  using enum Observation;
  const Parameters parameters;
  VoxelEvidence evidence;
  std::size_t scan = 70'000;  // The number of the first one.
  for (const Observation seen : {kFree, kOccluded, kFree, kAgree, kFree, kAgree, kUnknown, kFree}) {
    add_observation(seen, 10.0F, scan++, parameters, evidence);
  }
  add_observation(kFree, 30.0F, scan, parameters, evidence);  // Farther than 20 m: not of a run.
  CHECK(evidence.agree_scans == 2);
  CHECK(evidence.free_scans == 5);
  CHECK(evidence.leading_free == 2);
  CHECK(evidence.trailing_free == 1);
  CHECK(evidence.first_agree == 70'003);
  CHECK(evidence.last_agree == 70'005);
}

TEST_CASE("every voxel in range is asked of a scan, and decided on") {
  // Voxels 5, 10 and 15 m ahead, one to the side. The scan has a return at 10 m.
  toy::MapPoints points;
  EvidenceMap& map = points.map;
  const auto front = points.add({5.02, 0.02, 0.02}), hit = points.add({10.02, 0.02, 0.02});
  const auto behind = points.add({15.02, 0.02, 0.02}), aside = points.add({0.0, 9.0, 0.0});
  const WhenToDecide when = GENERATE(WhenToDecide::kNow, WhenToDecide::kLater);
  for (int scan = 0; scan < 2; ++scan) {
    const RangeImage image = image_of_return(10.0F);
    const PosedImage posed{&image, Pose::Identity(), 4 + static_cast<std::size_t>(scan)};
    add_evidence(std::span(&posed, 1), Parameters{}, when, RunContext{}, map);
  }
  if (when == WhenToDecide::kLater) {
    CHECK(map.decision(front) == Verdict::kUndecided);
    decide_all(false, Parameters{}, RunContext{}, map);
  }
  CHECK(map.evidence(front).free_scans == 2);
  CHECK(map.decision(front) == Verdict::kDynamic);
  CHECK(map.evidence(hit).agree_scans == 2);
  CHECK(map.evidence(hit).first_agree == 4);
  CHECK(map.evidence(hit).last_agree == 5);
  CHECK(map.decision(hit) == Verdict::kStatic);
  for (const auto unseen : {behind, aside}) {
    CHECK(map.evidence(unseen).free_scans + map.evidence(unseen).agree_scans == 0);
    CHECK(map.decision(unseen) == Verdict::kUndecided);
  }
}

TEST_CASE("a new voxel gets its evidence from the earlier scans that are kept") {
  // Of scans 0 to 4 every second one is kept, and of these the last two: 2 and 4. Scan 0 would
  // agree.
  Parameters parameters;
  parameters.history_scans = 2;
  EarlierScans earlier(parameters);
  std::size_t scan = 0;
  for (const float range : {5.0F, 5.0F, 10.0F, 5.0F, 12.0F}) {
    earlier.keep(image_of_return(range), Pose::Identity(), scan++);
  }
  toy::MapPoints points;
  EvidenceMap& map = points.map;
  const auto known = points.add({5.02, 0.02, 0.02}), fresh = points.add({5.22, 0.02, 0.02});
  const auto hit = points.add({10.02, 0.02, 0.02});
  earlier.add_evidence(fresh, {0.0, 0.0, 0.0}, WhenToDecide::kNow, RunContext{}, map);
  CHECK(map.evidence(fresh).free_scans == 2);
  CHECK(map.evidence(fresh).agree_scans == 0);
  CHECK(map.decision(fresh) == Verdict::kDynamic);
  CHECK(map.evidence(known).free_scans == 0);
  CHECK(map.evidence(hit).agree_scans == 1);
  CHECK(map.evidence(hit).first_agree == 2);
  CHECK(map.evidence(hit).last_agree == 2);
}
