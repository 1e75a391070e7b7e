// SPDX-License-Identifier: MIT
// Cells of 0.2 m, liboctomap's log-odds: hit +0.8473, miss -0.4055, clamped to [-2.0000, 3.5110].
// By default the sensor is at (0.1, 0.1, 0.1), and all cells are on the line y = z = 0.1: A is the
// cell of x = 1.1, W the cell of x = 2.1, A on the way to W.
#include "methods/octomap/octomap.h"

#include <catch2/catch.hpp>

#include "tests/methods/octomap/hand_scans.h"

namespace raymoval::octomap_test {
using namespace raymoval::octomap_method;

namespace {

const Eigen::Vector3d kA(1.1, 0.1, 0.1), kW(2.1, 0.1, 0.1);

Eigen::Vector3d at(double x) {
  return {x, 0.1, 0.1};
}

MaskStore masks(const ScanSource& scans, const Parameters& parameters = {}, int threads = 1) {
  return masks_of(*make_octomap(parameters), scans, threads);
}

/// `first` scans that see A, then `then` scans that see W.
HandScans seen(int first, int then) {
  HandScans scans;
  for (int i = 0; i < first; ++i) scans.add({kA});
  for (int i = 0; i < then; ++i) scans.add({kW});
  return scans;
}

/// What scan `scan` of 6 sees of a flat road of 10 m x 10 m at z = 0.03 and of a wall behind it:
/// the whole wall, and every sixth row of the road, rows 0.25 m apart.
[[maybe_unused]] Points road_and_wall(int scan) {
  Points points;
  for (double x = 0.12; x < 10; x += 0.25) {
    for (int row = scan; row < 40; row += 6) points.emplace_back(x, 0.12 + 0.25 * row, 0.03);
    for (double z = 0.5; z < 2; z += 0.25) points.emplace_back(x, 10.13, z);
  }
  return points;
}

}  // namespace

TEST_CASE("what parks late is occupied from its third scan, and the order of scans matters") {
  const auto parked_for = [](int scans_at_a) {
    HandScans scans = seen(0, 20);
    for (int i = 0; i < scans_at_a; ++i) scans.add({kA});
    return masks(scans).removed_count();
  };
  // -2.0000 + 0.8473 n: -1.1527, -0.3054, +0.5419.
  CHECK(parked_for(1) == 1);
  CHECK(parked_for(2) == 2);
  CHECK(parked_for(3) == 0);
  // The same scans the other way round: 3 hits, then 20 misses.
  CHECK(masks(seen(3, 20)).removed_count() == 3);
}

TEST_CASE("a beam beyond the maximum range is cut, and its end counts for nothing") {
  Parameters parameters;
  parameters.maximum_range = 1.0;
  HandMap map(parameters);
  map.insert({kW});
  CHECK(map.is_free(at(0.9)));
  CHECK_FALSE(map.knows(at(1.1)));  // The cell in which the beam is cut.
  CHECK_FALSE(map.knows(kW));
  parameters.cut_end_free = true;
  HandMap kth(parameters);
  kth.insert({kW});
  CHECK(kth.is_free(at(1.1)));
  CHECK_FALSE(kth.knows(at(1.3)));
}

TEST_CASE("a point in an unknown cell stays, or goes if wished") {
  Parameters parameters;
  parameters.maximum_range = 1.0;
  const HandScans scans = seen(0, 5);
  CHECK(masks(scans, parameters).removed_count() == 0);
  parameters.remove_unknown = true;
  CHECK(masks(scans, parameters).removed_count() == 5);
}

TEST_CASE("a point beyond the maximum range takes the state of its cell") {
  Parameters parameters;
  parameters.maximum_range = 1.5;
  HandScans scans;
  scans.add({kW});                                            // 2.0 m: cut.
  for (int i = 0; i < 3; ++i) scans.add({at(2.7)}, at(1.7));  // 1.0 m, through W.
  CHECK(masks(scans, parameters).get(0) == Mask{1});
}

#if RAYMOVAL_PCL
TEST_CASE("ground always stays") {
  // The sensor faces along the road from 10 m before it, 1.72 m above it. A beam that ends 15 m
  // away is in the road's layer of cells, 0.17 m above the road, for the last 1.5 m: six rows. So a
  // cell of the road is hit in one scan and crossed in up to five, and many are removed. A person
  // who is there in scan 0 is removed, too: beams to the wall cross the place five times.
  HandScans scans;
  for (int i = 0; i < 6; ++i) {
    Points points = road_and_wall(i);
    if (i == 0) points.emplace_back(5.05, 5.05, 1.5);
    scans.add(points, Eigen::Vector3d(5.05, -10.0, 1.75));
  }
  const auto road_removed = [&](const MaskStore& answer) {
    std::size_t removed = 0;
    for (int i = 0; i < 6; ++i) {
      const Points points = road_and_wall(i);
      const Mask mask = answer.get(static_cast<std::size_t>(i));
      for (std::size_t k = 0; k < points.size(); ++k) removed += points[k].z() < 0.1 ? mask[k] : 0;
    }
    return removed;
  };
  Parameters parameters;
  CHECK(road_removed(masks(scans, parameters)) > 400);  // Of 1600.
  parameters.ground = true;
  const MaskStore answer = masks(scans, parameters);
  CHECK(road_removed(answer) == 0);
  CHECK(answer.get(0).back() == 1);
}
#endif

TEST_CASE("points outside the tree stay, however many beams there are") {
  HandScans scans;
  for (int i = 0; i < 4; ++i) scans.add({{9000.0, 0.1, 0.1}, kW, {0.1, -1e30, 0.1}});
  Parameters parameters;
  parameters.remove_unknown = true;
  CHECK(masks(scans, parameters).removed_count() == 0);
}

TEST_CASE("the tree's centre is where the drive starts") {
  // A drive 500 km from the origin, as in UTM coordinates: the tree reaches 6.5 km, and float
  // holds half-metres there.
  HandScans here = seen(1, 3), there;
  const Eigen::Vector3d far(500000.0, -5400000.0, 200.0);
  there.add({kA + far}, at(0.1) + far);
  for (int i = 0; i < 3; ++i) there.add({kW + far}, at(0.1) + far);
  CHECK(masks(there).get(0) == masks(here).get(0));
  CHECK(masks(there).removed_count() == 1);
}

TEST_CASE("a maximum range of zero is refused") {
  Parameters parameters;
  parameters.maximum_range = 0.0;
  CHECK_THROWS_WITH(make_octomap(parameters), Catch::Contains("octomap.maximum_range"));
}

TEST_CASE("every point is answered as after plain calls of insertPointCloud", "[slow]") {
  const World world = street(8);
  octomap::OcTree plain(0.2);
  const auto world_points = [&](std::size_t i) {
    octomap::Pointcloud cloud;
    const Scan scan = world.load(i);
    for (const Eigen::Vector3f& p : scan.points) {
      cloud.push_back(rounded(scan.T_world_sensor * p.cast<double>()));
    }
    return cloud;
  };
  for (std::size_t i = 0; i < world.size(); ++i) {
    plain.insertPointCloud(world_points(i), rounded(world.pose(i).translation()));
  }
  // The street starts within 4 cm of the origin: the tree's centre is the world's.
  const MaskStore answer = masks(world, {}, 2);
  std::size_t removed = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    Mask expected;
    for (const octomap::point3d& p : world_points(i)) {
      expected.push_back(plain.isNodeOccupied(plain.search(p)) ? 0 : 1);
      removed += expected.back();
    }
    REQUIRE(answer.get(i) == expected);
  }
  CHECK(removed > 50);
}

}  // namespace raymoval::octomap_test
