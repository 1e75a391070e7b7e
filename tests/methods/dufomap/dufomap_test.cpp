// SPDX-License-Identifier: MIT
#include "methods/dufomap/dufomap.h"

#include <catch2/catch.hpp>

#include "tests/methods/dufomap/oracle.h"
#include "tests/methods/moved_world.h"

namespace raymoval::dufomap_test {

namespace {

MaskStore run(const ScanSource& scans, Parameters parameters = {}, bool offline = true,
              int threads = 1) {
  parameters.offline = offline;
  return toy::masks_of(*make_dufomap(parameters), scans, threads);
}

const toy::Box kWall{{8, -9, -2}, {8.5, 9, 2}};
const toy::Box kBody{{4.03, -0.5, -0.6}, {4.53, 0.5, 0.5}};

/// A wall in all five scans; a person is in front of it in scans 0 and 3.
toy::World passer_by() {
  toy::World world{toy::Scanner{-40, 40}};
  for (int i = 0; i < 5; ++i) {
    std::vector<toy::Box> boxes{kWall};
    if (i == 0 || i == 3) boxes.push_back(kBody);
    world.scan(boxes, Pose::Identity());
  }
  return world;
}

}  // namespace

TEST_CASE("what stood where a scan saw void is removed, before and after") {
  const toy::World world = passer_by();
  const MaskStore masks = run(world);
  // Beams half a degree apart leave no voxel of 0.1 m at 4 m unseen.
  CHECK(toy::removed_share(world, masks, 1, 0, 0) == 1.0);
  CHECK(toy::removed_share(world, masks, 1, 3, 3) == 1.0);
  CHECK(toy::removed_share(world, masks, 0, 0, 4) == 0.0);
}

TEST_CASE("online, the first appearance stays and the second goes") {
  const toy::World world = passer_by();
  const MaskStore masks = run(world, {}, false);
  CHECK(toy::removed_share(world, masks, 1, 0, 0) == 0.0);
  CHECK(toy::removed_share(world, masks, 1, 3, 3) == 1.0);
  CHECK(toy::removed_share(world, masks, 0, 0, 4) == 0.0);
}

TEST_CASE("online, later scans change nothing") {
  toy::World whole{toy::Scanner{-40, 40}}, start{toy::Scanner{-40, 40}};
  for (int i = 0; i < 6; ++i) {
    const double x = 6.53 - 0.7 * i;  // Towards the sensor, into what was seen empty before.
    const std::vector<toy::Box> boxes{kWall, {{x, -0.5, -0.6}, {x + 0.4, 0.5, 0.5}}};
    whole.scan(boxes, Pose::Identity());
    if (i < 4) start.scan(boxes, Pose::Identity());
  }
  // With more threads than scans left, too: later scans are then already at work.
  for (const int threads : {1, 3}) {
    const MaskStore of_whole = run(whole, {}, false, threads);
    const MaskStore of_start = run(start, {}, false, threads);
    CHECK(of_start.removed_count() > 0);
    CHECK(toy::different_verdicts(of_whole, of_start, 4) == 0);
  }
}

TEST_CASE("the hit extension stands range noise") {
  // The same wall 0.14 m apart: without d_s and d_p, the nearer wall is in the void of the other.
  toy::World world{toy::Scanner{-40, 40}};
  world.scan({{{5.03, -5, -2}, {5.6, 5, 2}}}, Pose::Identity());
  world.scan({{{5.17, -5, -2}, {5.7, 5, 2}}}, Pose::Identity());
  CHECK(run(world).removed_count() == 0);
  Parameters bare;
  bare.hit_extension = 0.0;
  bare.unknown_inflation = 0;
  CHECK(toy::removed_share(world, run(world, bare), 0, 0, 0) > 0.9);
  CHECK(toy::removed_share(world, run(world, bare), 0, 1, 1) == 0.0);
}

TEST_CASE("a larger d_p removes no point that a smaller one keeps") {
  // Without the compensation, which grows with d_p too, and without hits in the way.
  const toy::World world = toy::street(6);
  Parameters one, two;
  one.compensate_inflation = two.compensate_inflation = false;
  two.unknown_inflation = 2;
  const MaskStore of_one = run(world, one), of_two = run(world, two);
  std::size_t fewer = 0, more = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Mask a = of_one.get(i), b = of_two.get(i);
    for (std::size_t k = 0; k < a.size(); ++k) {
      more += b[k] > a[k] ? 1 : 0;
      fewer += b[k] < a[k] ? 1 : 0;
    }
  }
  CHECK(more == 0);
  CHECK(fewer > 0);
}

TEST_CASE("a point far out is refused, or cut by the maximum range") {
  toy::HeldScans scans;
  scans.add_world({0, 0, 0}, {{5, 0, 0}, {20000, 100, 0}});  // 20 km = 200,000 voxels.
  CHECK_THROWS_AS(run(scans), DataError);
  CHECK_THROWS_WITH(run(scans), Catch::Contains("scan 0") && Catch::Contains("maximum_range"));
  Parameters near;
  near.maximum_range = 50.0;
  CHECK(run(scans, near).get(0) == Mask{0, 0});
}

}  // namespace raymoval::dufomap_test
