// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence_map.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

TEST_CASE("blocks hold what was put into their cells, for either sign") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> coordinate(-40, 40);
  DenseBlocks<int, 2, 4> blocks(-1);
  DenseBlocks<int, 2, 4>::Cursor cursor, reading;
  std::map<VoxelKey, int> oracle;
  for (int i = 0; i < 5000; ++i) {
    const VoxelIndex cell(coordinate(random), coordinate(random), coordinate(random));
    blocks.make(cell, cursor) = i;
    oracle[voxel_key(cell)] = i;
  }
  for (int i = 0; i < 20000; ++i) {
    const VoxelIndex cell(coordinate(random), coordinate(random), coordinate(random));
    const auto found = oracle.find(voxel_key(cell));
    REQUIRE(blocks.get(cell, reading) == (found == oracle.end() ? -1 : found->second));
  }
  CHECK(blocks.get({1000, 0, 0}, reading) == -1);
}

TEST_CASE("a voxel has the mean of its points, and is found within range of it") {
  MapPoints points;
  EvidenceMap& map = points.map;
  // Two points of one voxel, and one of a voxel 40 m away, some tiles of 12.8 m farther.
  const auto near = points.add({-0.15, 0.05, 1.05});
  CHECK(points.add({-0.05, 0.15, 1.05}) == near);
  const auto far = points.add({40.1, 0.1, 1.1});
  CHECK(map.size() == 2);
  CHECK(points.find({-0.01, 0.01, 1.19}) == near);
  CHECK(points.find({0.01, 0.01, 1.19}) == EvidenceMap::kNone);
  CHECK((map.centroid(near) - Eigen::Vector3d(-0.1, 0.1, 1.05)).norm() < 0.001);  // 1/256 of 0.2 m

  map.update_means();
  const auto tiles = map.tiles_near({0.0, 0.0, 0.0}, 5.0);
  REQUIRE(tiles.size() == 1);
  const EvidenceMap::Tile& tile = map.tile(tiles[0]);
  REQUIRE(tile.voxels == std::vector{near});
  const Eigen::Vector3f mean = Eigen::Map<const Eigen::Vector3f>(tile.places.data());
  CHECK((tile.origin + mean.cast<double>() - map.centroid(near)).norm() < 1e-5);
  CHECK(map.tiles_near({0.0, 0.0, 0.0}, 40.0).size() == 2);

  map.set_decision(far, Verdict::kDynamic);
  CHECK(map.dynamic_in(map.block_of(far)) == 1);
  map.set_decision(far, Verdict::kStatic);
  CHECK(map.dynamic_in(map.block_of(far)) == 0);
}

TEST_CASE("a roof stands alone in its column, one voxel high or two") {
  // Other voxels at these heights above it, metres.
  struct Others {
    std::vector<double> above;
    bool is_roof;
  };
  const auto [above, is_roof] = GENERATE(
      Others{{}, true}, Others{{0.2}, true}, Others{{-0.2}, true}, Others{{-0.2, 0.2}, false},
      Others{{0.4}, false}, Others{{-1.6}, false}, Others{{1.6}, false}, Others{{-1.8, 1.8}, true});
  MapPoints points;
  const Eigen::Vector3d at(-3.95, 7.05, -0.55);
  const auto roof = points.add(at);
  for (const double metres : above) points.add(at + Eigen::Vector3d(0.0, 0.0, metres));
  points.add(at + Eigen::Vector3d(0.2, 0.0, -0.4));  // Beside it.
  CAPTURE(above);
  EvidenceMap::Blocks::Cursor cursor;
  CHECK(points.map.is_roof(roof, cursor) == is_roof);
}

TEST_CASE("a column goes on over gaps, but not over wide ones") {
  // Voxels of 0.2 m at these heights above the first one, metres, one of which is aside.
  MapPoints points;
  const auto at = [](double height) { return Eigen::Vector3d(-3.95, 7.05, -0.55 + height); };
  const auto first = points.add(at(0.0));
  for (const double height : {-0.2, 0.6, 1.6, 2.8}) points.add(at(height));
  points.add(at(2.2) + Eigen::Vector3d(0.2, 0.0, 0.0));
  EvidenceMap::Blocks::Cursor cursor;
  const auto reaches = [&](double height) {
    return points.map.column_reaches(first, at(height).z(), cursor);
  };
  CHECK(reaches(0.0));
  CHECK(reaches(-0.2));
  CHECK_FALSE(reaches(-0.4));
  CHECK(reaches(0.4));
  CHECK(reaches(1.6));  // Over 0.8 m, four cells.
  CHECK_FALSE(reaches(1.8));
  CHECK_FALSE(reaches(2.8));  // Over 1 m.
}

}  // namespace raymoval::raymoval_plus_test
