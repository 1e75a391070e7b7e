// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/located_scan.h"

#include <catch2/catch.hpp>
#include <random>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A scan of some points of the world, at some heights above the ground.
LocatedScan located(const std::vector<Eigen::Vector3d>& points, const std::vector<float>& heights,
                    const EvidenceMaps& maps) {
  LocatedScan scan;
  for (const Eigen::Vector3d& point : points) scan.scan.points.push_back(point.cast<float>());
  scan.height = heights;
  maps.standing.find_cells_of(scan.scan, 1, scan.in_map);
  return scan;
}

/// Makes the decision on each voxel of a map a verdict.
void set_verdicts(EvidenceMap& map, Verdict verdict) {
  for (std::uint32_t voxel = 0; voxel < map.size(); ++voxel) map.set_decision(voxel, verdict);
  for (std::uint32_t block = 0; block < map.blocks().block_count(); ++block) {
    map.take_decisions(block);
  }
}

}  // namespace

TEST_CASE("the cell of a ground point is that of a lattice twice as wide") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-40.0F, 40.0F);
  Scan scan;
  for (int i = 0; i < 5000; ++i) {
    scan.points.emplace_back(place(random), place(random), place(random));
  }
  const EvidenceMaps maps{Parameters{}};
  ScanCells fine, coarse;
  maps.standing.find_cells_of(scan, 1, fine);
  maps.ground.find_cells_of(scan, 1, coarse);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    REQUIRE(ground_cell(fine[k]) == coarse[k]);
    REQUIRE(ground_parts(fine[k], fine.parts[k]) == coarse.parts[k]);
  }
}

TEST_CASE("what stands and the ground below it have voxels and verdicts of their own") {
  const Parameters parameters;
  EvidenceMaps maps{parameters};
  // Two points of the road and one 0.1 m above it, in a voxel of the road.
  LocatedScan scan = located({{5.25, 0.1, 0.01}, {5.55, 0.1, 0.02}, {5.25, 0.1, 0.11}},
                             {0.01F, 0.02F, 0.11F}, maps);
  add_to_maps(parameters, RunContext{}, scan, maps);
  CHECK(maps.sizes() == std::array<std::size_t, 2>{1, 1});
  CHECK(scan.voxel == std::vector<std::uint32_t>{EvidenceMap::kNone, EvidenceMap::kNone, 0});
  CHECK(scan.ground_voxel == std::vector<std::uint32_t>{0, 0, EvidenceMap::kNone});
  for (const auto& [standing, ground] : {std::pair{Verdict::kDynamic, Verdict::kStatic},
                                         std::pair{Verdict::kStatic, Verdict::kDynamic}}) {
    set_verdicts(maps.standing, standing);
    set_verdicts(maps.ground, ground);
    look_up(maps, parameters, RunContext{}, scan);
    CHECK(scan.verdict == std::vector<Verdict>{ground, ground, standing});
  }
}

TEST_CASE("a point whose height is found anew moves from one map to the other") {
  const Parameters parameters;
  EvidenceMaps maps{parameters};
  LocatedScan scan =
      located({{5.0, 0.1, 0.01}, {9.0, 0.1, 0.5}, {13.0, 0.1, 0.5}}, {0.01F, 0.5F, 0.5F}, maps);
  add_to_maps(parameters, RunContext{}, scan, maps);
  CHECK(maps.sizes() == std::array<std::size_t, 2>{2, 1});
  scan.height = {0.6F, 0.02F, 0.5F};
  correct_voxels(parameters, RunContext{}, scan, maps);
  CHECK(scan.voxel == std::vector<std::uint32_t>{2, EvidenceMap::kNone, 1});
  CHECK(scan.ground_voxel == std::vector<std::uint32_t>{EvidenceMap::kNone, 1, EvidenceMap::kNone});
  CHECK(maps.standing.centroid(2).x() == Approx(5.0).margin(0.001));
  CHECK(maps.ground.centroid(1).x() == Approx(9.0).margin(0.002));
  CHECK(maps.sizes() == std::array<std::size_t, 2>{3, 2});
}

}  // namespace raymoval::raymoval_plus_test
