// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/first_hit.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

TEST_CASE("a voxel that is entered at the very end of the range counts, at either end") {
  // In the sensor's own brick, in the next one, and behind an empty one: the middle of a voxel is
  // half a metre from its wall.
  for (const int x : {5, 8, 16}) {
    const Ray ray{{0.5, 0.5, 0.5}, {1, 0, 0}};
    const double range = x - 0.5;
    OccupancyMap map(1.0);
    map.insert({x, 0, 0});
    INFO(x);
    REQUIRE(cast_ray(map, ray, {range, range}));
    CHECK(cast_ray(map, ray, {range, range})->range == range);
    CHECK_FALSE(cast_ray(map, ray, {0.0, range - 0.001}));
    CHECK_FALSE(cast_ray(map, ray, {range + 0.001, 60.0}));
  }
}

TEST_CASE("a ray through an edge of voxels passes the one beside it along the last axis") {
  const auto meets = [](const Eigen::Vector3d& direction, const VoxelIndex& voxel) {
    OccupancyMap map(1.0);
    map.insert(voxel);
    return cast_ray(map, {{0.5, 0.5, 0.5}, direction.normalized()}, {0.0, 60.0}).has_value();
  };
  CHECK(meets({1, 1, 0}, {0, 1, 0}));
  CHECK_FALSE(meets({1, 1, 0}, {1, 0, 0}));
  CHECK(meets({1, 0, 1}, {0, 0, 1}));
  CHECK_FALSE(meets({1, 0, 1}, {1, 0, 0}));
  CHECK(meets({0, 1, 1}, {0, 0, 1}));
  CHECK_FALSE(meets({0, 1, 1}, {0, 1, 0}));
  // Through a corner: z, then y, then x.
  for (const VoxelIndex& met : {VoxelIndex(0, 0, 1), VoxelIndex(0, 1, 1), VoxelIndex(1, 1, 1)}) {
    CHECK(meets({1, 1, 1}, met));
  }
  for (const VoxelIndex& missed : {VoxelIndex(1, 0, 0), VoxelIndex(0, 1, 0), VoxelIndex(1, 0, 1)}) {
    CHECK_FALSE(meets({1, 1, 1}, missed));
  }
}

TEST_CASE("a ray may begin farther on, and still tells where it entered the voxel") {
  OccupancyMap map(1.0);
  map.insert({0, 0, 0});
  map.insert({3, 0, 0});
  for (const int sign : {1, -1}) {
    // 0.5 m before the one voxel and, the other way, behind the other.
    const Ray ray{{sign > 0 ? -0.5 : 4.5, 0.5, 0.5}, {1.0 * sign, 0, 0}};
    const VoxelIndex near(sign > 0 ? 0 : 3, 0, 0), far(sign > 0 ? 3 : 0, 0, 0);
    const auto from = [&](double metres) {
      const auto hit = cast_ray(map, ray, {0.0, 60.0}, metres);
      REQUIRE(hit);
      CHECK(hit->range == (hit->voxel == near ? 0.5 : 3.5));
      return hit->voxel;
    };
    CHECK(from(0.0) == near);
    CHECK(from(0.25) == near);
    CHECK(from(0.75) == near);
    CHECK(from(1.75) == far);
    CHECK(from(3.75) == far);
    CHECK_FALSE(cast_ray(map, ray, {0.0, 60.0}, 4.75));
    CHECK_FALSE(cast_ray(map, ray, {0.0, 3.0}, 1.75));  // Beyond the range.
  }
}

TEST_CASE("a ray ends although no range limits it") {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  OccupancyMap map(0.2);
  map.insert({kVoxelLimit, 0, 0});
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 0),
        Eigen::Vector3d(1, 1, 1).normalized().eval()}) {
    const auto hit = cast_ray(map, {{0.1, 0.1, 0.1}, direction}, {0.0, kNoLimit});
    CHECK(hit.has_value() == (direction == Eigen::Vector3d(1, 0, 0)));
  }
  const double end = -0.2 * kVoxelLimit;  // Across the whole lattice.
  CHECK(cast_ray(map, {{end, 0.1, 0.1}, {1, 0, 0}}, {0.0, kNoLimit}));
}

TEST_CASE("a ray that starts on walls and is next to level is in the lower voxel at once") {
  OccupancyMap map(1.0);
  map.insert({5, -1, -1});
  for (const double tiny : {5e-324, 1e-310, 1e-308, 1e-200, 1e-20}) {
    const auto hit = cast_ray(map, {{0, 0, 0}, {1, -tiny, -tiny}}, {0.0, 60.0});
    INFO(tiny);
    REQUIRE(hit);
    CHECK(hit->range == 5.0);
    CHECK_FALSE(cast_ray(map, {{0, 0, 0}, {1, tiny, -tiny}}, {0.0, 60.0}));
    CHECK_FALSE(cast_ray(map, {{0, 0, 0}, {1, 0, 0}}, {0.0, 60.0}));
    CHECK_FALSE(cast_ray(map, {{0, 0, 0}, {-1, -tiny, -tiny}}, {0.0, 60.0}));
  }
}

namespace {

/// Slow exact answer: every voxel of the map as a box.
std::optional<FirstHit> brute_force(const std::vector<VoxelIndex>& voxels, double size,
                                    const Ray& ray, double nearest, double farthest) {
  std::optional<FirstHit> best;
  for (const VoxelIndex& voxel : voxels) {
    const Eigen::Vector3d low = voxel.cast<double>() * size;
    const toy::Box box{low, low.array() + size};
    const double range = toy::enter_distance(box, ray.origin, ray.direction);
    if (range >= nearest && range <= farthest && (!best || range < best->range)) {
      best = FirstHit{range, voxel};
    }
  }
  return best;
}

}  // namespace

TEST_CASE("eq. 7: first hits equal those of a test of every voxel") {
  std::mt19937 random(7);
  const auto pick = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (int round = 0; round < 30; ++round) {
    // Far from the origin as well as around it, sparse and dense.
    const VoxelIndex centre =
        round % 3 == 0 ? VoxelIndex(400000, -300000, 77) : VoxelIndex(0, 0, 0);
    OccupancyMap map(0.2);
    std::vector<VoxelIndex> voxels;
    for (int k = 0; k < (round % 2 == 0 ? 20 : 400); ++k) {
      const VoxelIndex voxel =
          centre + VoxelIndex(static_cast<int>(pick(-20, 20)), static_cast<int>(pick(-20, 20)),
                              static_cast<int>(pick(-20, 20)));
      if (map.insert(voxel)) voxels.push_back(voxel);
    }
    const double nearest = round % 4 == 1 ? 0.0 : 0.5;  // 0: also the voxel that a ray starts in.
    for (int k = 0; k < 200; ++k) {
      Ray ray;
      ray.origin =
          centre.cast<double>() * 0.2 + Eigen::Vector3d(pick(-3, 3), pick(-3, 3), pick(-3, 3));
      ray.direction = Eigen::Vector3d(pick(-1, 1), pick(-1, 1), pick(-1, 1)).normalized();
      const auto expected = brute_force(voxels, 0.2, ray, nearest, 6.0);
      const auto found = cast_ray(map, ray, {nearest, 6.0});
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      CHECK(found->range == Approx(expected->range).margin(1e-6));
      CHECK(found->voxel == expected->voxel);
    }
  }
}

}  // namespace raymoval::raymoval_test
