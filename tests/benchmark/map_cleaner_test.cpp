// SPDX-License-Identifier: MIT
#include "benchmark/map_cleaner.h"

#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

/// Three points, seen from x = 10.
Scan scan() {
  Scan result;
  result.T_world_sensor = Pose(Eigen::Translation3d(10.0, 0.0, 0.0));
  result.points = {{0.1F, 0.0F, 0.0F}, {0.3F, 0.0F, 0.0F}, {5.0F, 0.0F, 0.0F}};
  result.reflectance = {0.2F, 0.4F, 1.0F};
  return result;
}

}  // namespace

TEST_CASE("Points of the wanted side are kept in the world frame") {
  MapCollector kept(0.0);
  kept.add(scan(), {0, 0, 1}, 0);
  REQUIRE(kept.points().size() == 2);
  CHECK(kept.points()[1].x() == Approx(10.3));
  CHECK(kept.reflectance() == std::vector<float>{0.2F, 0.4F});
}

TEST_CASE("With a voxel size each cell gives its mean, in order of cells") {
  MapCollector kept(0.5);  // 10.1 and 10.3 share [10, 10.5); 15 is a cell of its own.
  kept.add(scan(), {0, 0, 0}, 0);
  kept.add(scan(), {1, 1, 0}, 0);
  REQUIRE(kept.points().size() == 2);
  CHECK(kept.points()[0].x() == Approx(10.2));
  CHECK(kept.points()[1].x() == Approx(15.0));
  CHECK(kept.reflectance()[0] == Approx(0.3));
}
