// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/methods/raymoval_plus/map_points.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;
using namespace raymoval::raymoval_plus_method;

namespace {

/// The image of a scan with one return `range` metres ahead of the sensor.
RangeImage image_of_return(float range) {
  Scan scan;
  scan.points.emplace_back(range, 0.02F, 0.02F);
  RangeImage image(Scanner{}.model(), Parameters{});
  image.fill(scan);
  return image;
}

/// Observes all voxels in an image.
void ask(const RangeImage& image, const Scan& scan, EvidenceMap& map) {
  const PosedImage posed{&image, scan.T_world_sensor, 0};
  add_evidence(std::span(&posed, 1), Parameters{}, WhenToDecide::kLater, RunContext{}, map);
}

/// The verdict on a voxel with 10 free scans. No beam of the scans in `beside` passed at the height
/// of the voxel's points.
Verdict decided_with(std::uint16_t agree, const ScansBeside& beside, int height_scans = 5) {
  Parameters parameters;
  parameters.height_scans = height_scans;
  const VoxelEvidence evidence{10, agree, 0, 3, 0, 0, {}, beside};
  CHECK(Decisions(parameters)(evidence) == decide(evidence, parameters));
  return decide(evidence, parameters);
}

}  // namespace

TEST_CASE("scans that see through are weighed against scans that agree") {
  const auto decided = [](std::uint16_t free, std::uint16_t agree, std::uint16_t leading = 0,
                          std::uint16_t trailing = 0) {
    return decide({free, agree, leading, trailing}, Parameters{});
  };
  // Needed: 1 + 0.3 x the supporting scans.
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

TEST_CASE("where some scans agree, those beside the voxel's points are not heard between them") {
  // Needed of the 10 free scans: 1 + 0.3 x 20.
  CHECK(decided_with(20, {}) == Verdict::kDynamic);
  CHECK(decided_with(20, {0, 3, 0}) == Verdict::kDynamic);
  CHECK(decided_with(20, {0, 4, 0}) == Verdict::kStatic);
  // After the last supporting scan, they count: an object that left may be observed from afar only.
  CHECK(decided_with(20, {0, 3, 3}) == Verdict::kDynamic);
  // Supporting scans without a beam at that height do not count either.
  CHECK(decided_with(20, {7, 4, 0}) == Verdict::kDynamic);
  CHECK(decided_with(4, {0, 9, 0}) == Verdict::kDynamic);  // Too few supporting scans.
  CHECK(decided_with(20, {0, 4, 0}, 0) == Verdict::kDynamic);
}

TEST_CASE("where many scans agree, those beside the whole column are not heard at all") {
  // Needed of the 10 free scans: 1 + 0.3 x 20.
  CHECK(decided_with(20, {0, 0, 0, 2, 1}) == Verdict::kDynamic);
  CHECK(decided_with(20, {0, 0, 0, 2, 2}) == Verdict::kStatic);
  CHECK(decided_with(20, {0, 2, 0, 1, 1}) == Verdict::kStatic);
  CHECK(decided_with(20, {0, 0, 0, 2, 2}, 6) == Verdict::kStatic);
  CHECK(decided_with(20, {0, 0, 0, 2, 2}, 7) == Verdict::kDynamic);  // Too few supporting scans.
  CHECK(decided_with(20, {0, 0, 0, 2, 2}, 0) == Verdict::kDynamic);
}

TEST_CASE("scans beside the whole column count before the first and since the last that agrees") {
  using enum Observation;
  const Parameters parameters;
  VoxelEvidence evidence;
  const auto add = [&](Observation what, bool is_beside_column) {
    add_observation({what, 10.0F, 0, is_beside_column, is_beside_column}, parameters, evidence);
  };
  for (const bool is_beside_column : {true, false, true}) add(kFree, is_beside_column);
  CHECK(evidence.beside.column_before == 2);
  CHECK(evidence.leading_free == 1);  // They are not of a run.
  add(kAgree, false);
  for (const bool is_beside_column : {true, false, true, true}) add(kFree, is_beside_column);
  CHECK(evidence.beside.column_since == 3);
  CHECK(evidence.trailing_free == 1);
  add(kAgree, false);
  CHECK(evidence.beside.column_since == 0);  // All were between supporting scans, ...
  CHECK(evidence.beside.free_between_agreeing == 3);
  CHECK(evidence.beside.column_before == 2);  // ... but not these.
  CHECK(evidence.free_scans == 7);
}

TEST_CASE("scans that pass beside a voxel's points are counted by themselves as well") {
  using enum Observation;
  const Parameters parameters;
  VoxelEvidence evidence;
  const auto add = [&](Observation what, bool is_beside) {
    add_observation({what, 10.0F, 0, is_beside}, parameters, evidence);
  };
  for (const bool is_beside : {true, false, true}) add(kFree, is_beside);
  for (const bool is_beside : {false, true, true}) add(kAgree, is_beside);
  CHECK(evidence.beside.agree == 2);
  CHECK(evidence.beside.free_between_agreeing == 0);
  for (const bool is_beside : {true, false, true}) add(kFree, is_beside);
  CHECK(evidence.beside.free_since == 2);
  CHECK(evidence.beside.free_between_agreeing == 0);
  add(kAgree, false);
  add(kFree, true);
  CHECK(evidence.free_scans == 7);
  CHECK(evidence.trailing_free == 1);
  CHECK(evidence.beside.free_between_agreeing == 2);
  CHECK(evidence.beside.free_since == 1);
}

TEST_CASE("a beam above or below points passes beside them, one at their height does not") {
  // The top of a van, 1 m above the sensor and 20 m ahead, whose points are 1 cm above and below
  // their mean, and its side; and a scan with farther returns in some beams, at these heights above
  // that mean, metres.
  struct Beams {
    std::vector<double> above;
    bool is_beside;
  };
  const auto [above, is_beside] =
      GENERATE(Beams{{-0.13}, true}, Beams{{-0.09}, false}, Beams{{0.0}, false},
               Beams{{0.09, -0.13}, false}, Beams{{0.13, -0.13}, true});
  const bool is_tilted = GENERATE(false, true);  // A slightly pitched sensor gives the same.
  MapPoints points;
  EvidenceMap& map = points.map;
  const auto roof = points.add({20.02, 0.02, 1.03});
  points.add({20.06, 0.06, 1.05});
  points.add({20.04, 0.04, 0.25});
  Scan scan;
  if (is_tilted) {
    scan.T_world_sensor.linear() =
        Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
  }
  for (const double high : above) {
    const Eigen::Vector3d beyond = 2.0 * Eigen::Vector3d(20.04, 0.04, 1.04 + high);
    scan.points.push_back((scan.T_world_sensor.inverse() * beyond).cast<float>());
  }
  SensorModel sensor = Scanner{}.model();
  // Equal steps both ways mean a sensor without even beams, for which `ScansBeside` stays 0.
  const bool has_beams = GENERATE(true, false);
  CAPTURE(above, is_tilted, has_beams);
  if (has_beams) sensor.azimuth_step = 0.25 * kDegree;
  RangeImage image(sensor, Parameters{});
  image.fill(scan);
  map.evidence(roof).agree_scans = 1;
  ask(image, scan, map);
  REQUIRE(map.evidence(roof).free_scans == 1);
  CHECK(map.evidence(roof).beside.free_since == (is_beside && has_beams ? 1 : 0));
}

TEST_CASE("a beam that passes a voxel's points is heard if it meets what stands above or below") {
  // A roof 1 m above the sensor and 18 m ahead. A scan has farther returns 0.5 m below it. An
  // object below the roof, if any, is this many metres lower.
  struct Below {
    std::vector<double> metres;
    bool is_beside_column;
  };
  const auto [below, is_beside_column] =
      GENERATE(Below{{}, true}, Below{{0.2}, true}, Below{{0.2, 0.6}, false}, Below{{0.6}, false},
               Below{{0.9}, false}, Below{{1.1}, true}, Below{{-0.2}, true});
  MapPoints points;
  EvidenceMap& map = points.map;
  const Eigen::Vector3d place(18.05, 0.05, 1.05);
  const auto roof = points.add(place);
  for (const double metres : below) points.add(place - Eigen::Vector3d(0.0, 0.0, metres));
  Scan scan;
  scan.T_world_sensor.translation().z() = GENERATE(0.0, 0.1);
  const Eigen::Vector3d passed = place - Eigen::Vector3d(0.0, 0.0, 0.5);
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  scan.points.push_back((2.0 * (passed - sensor)).cast<float>());
  SensorModel model = Scanner{}.model();
  model.azimuth_step = 0.25 * kDegree;
  model.elevation_step = 1.7 * kDegree;  // 0.5 m at that range.
  RangeImage image(model, Parameters{});
  image.fill(scan);
  CAPTURE(below);
  // Clang 14 cannot capture a structured binding by reference.
  const auto check = [&, is_beside_column = is_beside_column] {
    REQUIRE(map.evidence(roof).free_scans == 1);
    CHECK(map.evidence(roof).beside.column_before == (is_beside_column ? 1 : 0));
    CHECK(map.evidence(roof).leading_free == (is_beside_column ? 0 : 1));
  };
  SECTION("by the scans in turn") {
    ask(image, scan, map);
    check();
  }
  SECTION("by earlier scans, for new voxels") {
    EarlierScans earlier{Parameters{}};
    earlier.keep(std::move(image), scan.T_world_sensor, 0);
    earlier.add_evidence(0, sensor, WhenToDecide::kLater, RunContext{}, map);
    check();
  }
}

TEST_CASE("a beam just below a roof that is seen from below is not heard") {
  // A roof, 18 m ahead and `up` metres above the sensor; below it, perhaps, an object at a given
  // distance. A scan has farther returns, which pass at a given distance below the roof.
  struct Roof {
    double passed_below, up, below;
    bool is_heard;
  };
  const auto [passed_below, up, below, is_heard] = GENERATE(
      Roof{0.05, 1.05, 0.0, false}, Roof{-0.05, 1.05, 0.0, false}, Roof{0.01, 1.05, 0.0, true},
      Roof{-0.01, 1.05, 0.0, true}, Roof{0.05, -0.55, 0.0, true}, Roof{0.05, 1.05, 0.2, false},
      Roof{0.05, 1.05, 0.4, true}, Roof{0.05, 1.05, 1.6, true}, Roof{0.05, 1.05, 1.8, false});
  MapPoints points;
  EvidenceMap& map = points.map;
  const Eigen::Vector3d place(18.05, 0.05, up), upward = Eigen::Vector3d::UnitZ();
  const auto roof = points.add(place);
  if (below > 0.0) points.add(place - below * upward);
  Scan scan;
  scan.points.push_back((2.0 * (place - passed_below * upward)).cast<float>());
  SensorModel model = Scanner{}.model();
  model.azimuth_step = 0.25 * kDegree;
  model.elevation_step = 1.7 * kDegree;
  RangeImage image(model, Parameters{});
  image.fill(scan);
  ask(image, scan, map);
  CAPTURE(passed_below, up, below);
  REQUIRE(map.evidence(roof).free_scans == 1);
  CHECK(map.evidence(roof).beside.column_before == (is_heard ? 0 : 1));
  CHECK(map.evidence(roof).leading_free == (is_heard ? 1 : 0));
}

TEST_CASE("decisions on many voxels are those of the formula") {
  std::mt19937 random(9);
  const auto count = [&](unsigned most) { return static_cast<std::uint16_t>(random() % most); };
  for (const double constant : {0.001, 1.0, 2.5}) {
    for (const int run_scans : {0, 4}) {
      Parameters parameters;
      parameters.free_constant = constant;
      parameters.run_scans = run_scans;
      const Decisions decided(parameters);
      for (int i = 0; i < 3000; ++i) {
        VoxelEvidence evidence{count(i % 2 == 0 ? 10 : 200), count(i % 3 == 0 ? 3 : 600), count(6),
                               count(6)};
        evidence.beside = {count(evidence.agree_scans + 1U), count(evidence.free_scans + 1U), 0};
        REQUIRE(decided(evidence) == decide(evidence, parameters));
      }
    }
  }
}

TEST_CASE(
    "however few scans must see through, a voxel of which no scan says anything is undecided") {
  Parameters parameters;
  parameters.free_constant =
      find_parameter("raymoval_plus", parameter_table().specs(), "free_constant").notes.minimum;
  CHECK(decide({}, parameters) == Verdict::kUndecided);
  CHECK(Decisions(parameters)({}) == Verdict::kUndecided);
  CHECK(decide({.free_scans = 1}, parameters) == Verdict::kDynamic);
}

TEST_CASE("runs of scans that see through are counted at either end of a voxel's story") {
  using enum Observation;
  const Parameters parameters;
  VoxelEvidence evidence;
  std::size_t scan = 70'000;  // The number of the first one.
  for (const Observation seen : {kFree, kOccluded, kFree, kAgree, kFree, kAgree, kUnknown, kFree}) {
    add_observation({seen, 10.0F, scan++}, parameters, evidence);
  }
  // Farther than 20 m: not of a run.
  add_observation({kFree, 30.0F, scan}, parameters, evidence);
  CHECK(evidence.agree_scans == 2);
  CHECK(evidence.free_scans == 5);
  CHECK(evidence.leading_free == 2);
  CHECK(evidence.trailing_free == 1);
  CHECK(evidence.first_agree == 70'003);
  CHECK(evidence.last_agree == 70'005);
}

TEST_CASE("every voxel in range is asked of a scan, and decided on") {
  // Voxels 5, 10 and 15 m ahead, one to the side. The scan has a return at 10 m.
  MapPoints points;
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
    decide_all(Parameters{}, RunContext{}, map);
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
  // Of scans 0 to 4, every second one is stored, and of these the last two: 2 and 4. Scan 0 would
  // support the voxel.
  Parameters parameters;
  parameters.history_scans = 2;
  EarlierScans earlier(parameters);
  std::size_t scan = 0;
  for (const float range : {5.0F, 5.0F, 10.0F, 5.0F, 12.0F}) {
    earlier.keep(image_of_return(range), Pose::Identity(), scan++);
  }
  MapPoints points;
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

}  // namespace raymoval::raymoval_plus_test
