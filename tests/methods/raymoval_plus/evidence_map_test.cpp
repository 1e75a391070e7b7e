// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "methods/raymoval_plus/evidence/located_scan.h"
#include "tests/methods/raymoval_plus/map_points.h"

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

TEST_CASE("a voxel has the mean of its points, and is found within range of it") {
  MapPoints points;
  EvidenceMap& map = points.map;
  // Two points of one voxel, and one of a voxel 40 m away, some tiles of 12.8 m farther.
  const auto near = points.add({-0.15, 0.05, 1.05});
  CHECK(points.add({-0.05, 0.15, 1.05}) == near);
  points.add({40.1, 0.1, 1.1});
  CHECK(map.size() == 2);
  CHECK((map.centroid(near) - Eigen::Vector3d(-0.1, 0.1, 1.05)).norm() < 0.001);  // 1/256 of 0.2 m

  map.update_means();
  const auto tiles = map.tiles_near({0.0, 0.0, 0.0}, 5.0);
  REQUIRE(tiles.size() == 1);
  const EvidenceMap::Tile& tile = map.tile(tiles[0]);
  REQUIRE(tile.voxels == std::vector{near});
  const Eigen::Vector3f mean = Eigen::Map<const Eigen::Vector3f>(tile.places.data());
  CHECK((tile.origin + mean.cast<double>() - map.centroid(near)).norm() < 1e-5);
  CHECK(map.tiles_near({0.0, 0.0, 0.0}, 40.0).size() == 2);
}

TEST_CASE("a voxel has the distribution of its points, and a plane if they are on one") {
  // Nine points on a level square of 0.08 m: x and y have a variance of 0.04^2 m^2 x 2 / 3, and
  // 0.04^2 m^2 are added to that of all axes.
  for (const bool knows_planes : {true, false}) {
    EvidenceMap map(0.2, knows_planes);
    EvidenceMap::Blocks::Cursor cursor;
    const auto add = [&](double x, double y, double z) {
      const MapPoint at({x, y, z});
      return map.add(at.cell, at.parts, cursor);
    };
    for (int k = 0; k < 9; ++k) add(0.06 + 0.04 * (k % 3), 0.06 + 0.04 * (k / 3), 0.1);
    const VoxelShape flat = map.shape(0);
    CHECK(flat.xx == Approx(1.0 / (0.0016 + 0.0010667)).epsilon(0.02));
    CHECK(flat.yy == Approx(flat.xx).epsilon(0.02));
    CHECK(flat.zz == Approx(1.0 / 0.0016).epsilon(0.02));
    CHECK(flat.radius == Approx(std::sqrt(0.0026667)).epsilon(0.02));
    CHECK(std::abs(flat.nz) > 0.999F);
    // 0.04 m are more than 0.7 times 0.052 m, so that it is no plane; over 0.16 m they are less.
    CHECK(flat.behind == 0.0F);
    const auto wide = add(5.0 + 0.02, 0.02, 0.1);
    for (const double x : {0.02, 0.18}) {
      for (const double y : {0.02, 0.18}) add(5.0 + x, y, 0.1);
    }
    CHECK(map.shape(wide).behind == (knows_planes ? Approx(0.14).epsilon(0.01) : Approx(0.0)));
    map.see_from(wide, 12.0F);
    map.see_from(wide, 7.0F);
    map.see_from(wide, 9.0F);
    CHECK(map.shape(wide).nearest == 7.0F);
  }
}

}  // namespace raymoval::raymoval_plus_test
