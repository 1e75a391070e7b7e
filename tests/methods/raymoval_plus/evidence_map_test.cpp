// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

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
