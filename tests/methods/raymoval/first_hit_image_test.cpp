// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <numbers>
#include <set>

#include "core/angle.h"
#include "core/simd/instruction_set_scope.h"
#include "tests/methods/held_scans.h"
#include "tests/methods/raymoval/random_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using random_map::Random;
using toy::pose_at;

namespace {

/// Any size, from odd and tiny to several vectors a column.
AngularGrid random_grid(Random& random) {
  AngularGrid grid;
  grid.azimuth_bins = random.integer(1, 130);
  grid.elevation_bins = random.integer(1, 120);
  grid.elevation_min = random.real(-90, 20) * kDegree;
  grid.elevation_max = grid.elevation_min + random.real(5, 70) * kDegree;
  grid.elevation_max = std::min(grid.elevation_max, 90 * kDegree);
  return grid;
}

/// The image of three columns, the middle one of which looks along the sensor's x axis.
FirstHitImage look_ahead(OccupancyMap& map, const Pose& pose, const RayLimits& limits) {
  return cast_first_hits(map, pose, {3, 1, -0.1, 0.1}, limits, 1);
}

}  // namespace

TEST_CASE("images equal rays one by one, from any pose, on every instruction set", "[simd]") {
  Random random(11);
  random_map::Comparison total;
  for (int round = 0; round < 60; ++round) {
    const double size = random.real(0.05, 0.6);
    OccupancyMap map(size);
    // Around the origin, across it, and 50 km away.
    const VoxelIndex centre =
        round % 3 == 0 ? VoxelIndex(250000, -100000, 50) : VoxelIndex(0, 0, 0);
    random_map::fill(map, centre, 30, random);
    const Eigen::Vector3d shift(random.real(-8, 8), random.real(-8, 8), random.real(-5, 5));
    const Pose pose = random_map::pose((centre.cast<double>() + shift) * size, random,
                                       round % 2 == 0 ? 0.05 : std::numbers::pi);
    const AngularGrid grid = random_grid(random);
    const RayLimits limits{round % 4 == 0 ? 0.0 : random.real(0, 12) * size,
                           random.real(10, 80) * size};
    const FirstHitImage image = cast_first_hits(map, pose, grid, limits, 1);
    for (const InstructionSet set : supported_instruction_sets()) {
      INFO(instruction_set_name(set));
      const InstructionSetScope scope(set);
      REQUIRE(cast_first_hits(map, pose, grid, limits, 1).range == image.range);
    }
    REQUIRE(cast_first_hits(map, pose, grid, limits, 8).range == image.range);
    const auto compared = random_map::compare_with_rays(map, image);
    CHECK(compared.wrong == 0);
    total.bins += compared.bins;
    total.hits += compared.hits;
    total.ties += compared.ties;
  }
  INFO(total.bins << " bins, " << total.hits << " hits, " << total.ties << " ties");
  CHECK(total.hits > 100000);
  CHECK(total.ties <= total.bins / 100000 + 1);
}

TEST_CASE("directions along the lattice meet what is straight ahead", "[simd]") {
  // A box of walls around a sensor in the middle of a voxel: the columns' centres are at multiples
  // of 45 degrees, the first one at -180, and the rows at -45, 0 and 45 degrees.
  OccupancyMap map(1.0);
  for (int a = -5; a <= 5; ++a) {
    for (int b = -5; b <= 5; ++b) {
      for (const int wall : {-5, 5}) {
        map.insert({wall, a, b});
        map.insert({a, wall, b});
        map.insert({a, b, wall});
      }
    }
  }
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.5, 0.5, 0.5);
  pose.linear() = Eigen::AngleAxisd(-22.5 * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const AngularGrid grid{8, 3, -67.5 * kDegree, 67.5 * kDegree};
  for (const InstructionSet set : supported_instruction_sets()) {
    INFO(instruction_set_name(set));
    const InstructionSetScope scope(set);
    const FirstHitImage image = cast_first_hits(map, pose, grid, {0.0, 60.0}, 1);
    for (int i = 0; i < 8; ++i) {
      // From 0.5 to the walls' inner faces at 5 and -4 it is 4.5; 4.5 sqrt(2) across a corner. Up
      // or down by 45 degrees a ray of an even column reaches wall and floor or ceiling together,
      // one of an odd column the floor or ceiling first.
      const double level = i % 2 == 0 ? 4.5 : 4.5 * std::numbers::sqrt2;
      CHECK(image.range[static_cast<std::size_t>(8 + i)] == Approx(level).epsilon(1e-6));
      CHECK(image.range[static_cast<std::size_t>(i)] ==
            Approx(4.5 * std::numbers::sqrt2).epsilon(1e-6));
    }
  }
}

TEST_CASE("a sensor level with a layer of loose voxels sees them all around") {
  // Every second voxel of one layer from 3 m on, each of which the sensor's level plane cuts: many
  // more pieces than a map of walls has. Rays that look up pass over the layer, so that no brick is
  // hidden from the rows beside them.
  OccupancyMap map(0.2);
  for (int x = -80; x < 80; ++x) {
    for (int y = -80; y < 80; ++y) {
      if (((x + y) & 1) != 0 && x * x + y * y > 15 * 15) map.insert({x, y, 0});
    }
  }
  Random random(4);
  const Pose pose = random_map::pose({0.13, 0.07, 0.1}, random, 1e-4);
  const AngularGrid grid{360, 16, -0.01, 0.07};  // Two rows hit even the last voxels, at 16 m.
  const FirstHitImage image = cast_first_hits(map, pose, grid, {0.0, 30.0}, 1);
  const auto compared = random_map::compare_with_rays(map, image);
  CHECK(compared.wrong == 0);
  CHECK(compared.hits > 4 * 360);
  CHECK(image.range.back() == kNoRange);
}

TEST_CASE("a map that was changed gives the image of a map made at once") {
  Random random(5);
  OccupancyMap map(0.2);
  std::set<VoxelKey> voxels;
  const AngularGrid grid{90, 60, -0.8, 0.8};
  const Pose pose = random_map::pose({0.03, -0.07, 0.4}, random, 0.2);
  FirstHitCaster caster(grid, {0.5, 20.0});
  FirstHitImage image;
  for (int round = 0; round < 20; ++round) {
    for (int k = 0; k < 3000; ++k) {
      const VoxelIndex voxel(random.integer(-15, 15), random.integer(-15, 15),
                             random.integer(-15, 15));
      if (k % 2 == round % 2) {
        map.erase(voxel);
        voxels.erase(voxel_key(voxel));
      } else {
        map.insert(voxel);
        voxels.insert(voxel_key(voxel));
      }
    }
    caster.cast(map, pose, 1, image);
    OccupancyMap fresh(0.2);
    for (const VoxelKey key : voxels) fresh.insert(voxel_index(key));
    REQUIRE(cast_first_hits(fresh, pose, grid, {0.5, 20.0}, 1).range == image.range);
  }
}

TEST_CASE("the voxel of a hit is the one the exact ray meets") {
  OccupancyMap map(0.2);
  map.insert({10, 0, 0});
  const FirstHitImage image = look_ahead(map, pose_at(0.1, 0.1, 0.1), {0.0, 60.0});
  CHECK(image.voxel(map, 1) == VoxelIndex(10, 0, 0));
  CHECK_FALSE(image.voxel(map, 0));
  map.erase({10, 0, 0});
  CHECK_FALSE(image.voxel(map, 1));
}

}  // namespace raymoval::raymoval_test
