// SPDX-License-Identifier: MIT
#include "core/scan/voxel_key.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/error.h"

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("A point on a wall belongs to the upper cell, for either sign") {
  // Cells of 0.5 m: cell n holds n / 2 <= x < (n + 1) / 2.
  constexpr double kInverse = 2.0;
  for (const auto& [x, cell] : std::vector<std::pair<double, int>>{{0.0, 0},
                                                                   {0.25, 0},
                                                                   {0.5, 1},
                                                                   {1.0, 2},
                                                                   {-0.0, 0},
                                                                   {-1e-9, -1},
                                                                   {-0.25, -1},
                                                                   {-0.5, -1},
                                                                   {-0.5 - 1e-9, -2},
                                                                   {-1.0, -2},
                                                                   {std::nextafter(0.5, 0.0), 0}}) {
    CAPTURE(x);
    CHECK(voxel_index(Eigen::Vector3d(x, 0, 0), kInverse) == VoxelIndex(cell, 0, 0));
    CHECK(voxel_index(Eigen::Vector3d(0, x, 0), kInverse) == VoxelIndex(0, cell, 0));
    CHECK(voxel_index(Eigen::Vector3d(0, 0, x), kInverse) == VoxelIndex(0, 0, cell));
  }
}

TEST_CASE("Keys give their indices back") {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> any(-kVoxelLimit, kVoxelLimit);
  for (int i = 0; i < 10000; ++i) {
    const VoxelIndex index(any(random), any(random), any(random));
    REQUIRE(voxel_index(voxel_key(index)) == index);
  }
  for (const int end : {-kVoxelLimit, -1, 0, 1, kVoxelLimit}) {
    CHECK(voxel_index(voxel_key(end, -end, end)) == VoxelIndex(end, -end, end));
  }
}

TEST_CASE("Sorted keys run along x fastest, then y, then z") {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> near(-3, 3);
  for (int i = 0; i < 10000; ++i) {
    const VoxelIndex a(near(random), near(random), near(random));
    const VoxelIndex b(near(random), near(random), near(random));
    const std::array<int, 3> a_zyx{a.z(), a.y(), a.x()}, b_zyx{b.z(), b.y(), b.x()};
    REQUIRE((voxel_key(a) < voxel_key(b)) == (a_zyx < b_zyx));
  }
}

TEST_CASE("Beyond the lattice is an error and never another cell") {
  constexpr double kLast = kVoxelLimit;  // Cells of 1 m.
  CHECK(voxel_index(Eigen::Vector3d(kLast + 0.5, -kLast, 0), 1.0) ==
        VoxelIndex(kVoxelLimit, -kVoxelLimit, 0));
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {kLast + 1.0, -kLast - 0.5, 1e18, -1e300, inf, -inf,
                           std::numeric_limits<double>::quiet_NaN()}) {
    CAPTURE(bad);
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      point[axis] = bad;
      CHECK_THROWS_AS(voxel_index(point, 1.0), DataError);
    }
  }
  CHECK_THROWS_WITH(voxel_index(Eigen::Vector3d(3e6, 0, 0), 1.0),
                    Contains("(3e+06, 0, 0)") && Contains("1,048,575") && Contains("poses"));
}
