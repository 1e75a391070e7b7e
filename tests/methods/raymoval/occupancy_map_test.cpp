// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/occupancy_map.h"

#include <catch2/catch.hpp>
#include <set>

#include "methods/common/sparse_blocks.h"
#include "tests/methods/raymoval/random_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using random_map::Random;

namespace {

/// The voxels of a set of boxes.
Brick union_of(std::span<const BrickBox> boxes) {
  Brick brick;
  for (const BrickBox& box : boxes) {
    for (int x = box.first(0); x <= box.last(0); ++x) {
      for (int y = box.first(1); y <= box.last(1); ++y) {
        for (int z = box.first(2); z <= box.last(2); ++z) {
          brick.occupied[static_cast<std::size_t>(x)] |= Brick::bit(y, z);
        }
      }
    }
  }
  return brick;
}

std::vector<BrickBox> cover_of(const Brick& brick) {
  std::vector<BrickBox> boxes;
  cover_with_boxes(brick, boxes);
  return boxes;
}

}  // namespace

TEST_CASE("boxes cover exactly the voxels of a brick") {
  Random random(3);
  for (int round = 0; round < 500; ++round) {
    Brick brick;
    const double share = round % 5 == 0 ? 0.95 : random.real(0.0, 0.6);
    for (auto& word : brick.occupied) {
      for (int bit = 0; bit < 64; ++bit) {
        if (random.real(0, 1) < share) word |= std::uint64_t{1} << bit;
      }
    }
    REQUIRE(union_of(cover_of(brick)).occupied == brick.occupied);
  }
}

TEST_CASE("the map holds what a plain set holds, whatever comes and goes") {
  Random random(8);
  OccupancyMap map(0.2);
  std::set<VoxelKey> expected;
  for (int round = 0; round < 30; ++round) {
    for (int k = 0; k < 300; ++k) {
      const VoxelIndex voxel(random.integer(-20, 20), random.integer(-20, 20),
                             random.integer(-20, 20));
      if (random.integer(0, 2) == 0) {
        CHECK(map.erase(voxel) == (expected.erase(voxel_key(voxel)) == 1));
      } else {
        CHECK(map.insert(voxel) == expected.insert(voxel_key(voxel)).second);
      }
    }
    map.update_boxes(round % 3 + 1);
    REQUIRE(map.size() == expected.size());
    // The boxes that the raycasting sees are those of the voxels that are there now.
    std::size_t voxels = 0;
    for (OccupancyMap::Slot slot = 0; slot < map.brick_count(); ++slot) {
      const Brick covered = union_of(map.boxes(slot));
      REQUIRE(covered.occupied == map.brick(slot).occupied);
      for (const std::uint64_t word : covered.occupied) {
        voxels += static_cast<std::size_t>(std::popcount(word));
      }
    }
    REQUIRE(voxels == expected.size());
  }
}

TEST_CASE("a voxel nearby is found across the borders of bricks") {
  Random random(10);
  OccupancyMap map(0.2);
  for (int k = 0; k < 60; ++k) {
    map.insert({random.integer(-12, 12), random.integer(-12, 12), random.integer(-12, 12)});
  }
  for (int k = 0; k < 500; ++k) {
    const VoxelIndex voxel(random.integer(-14, 14), random.integer(-14, 14),
                           random.integer(-14, 14));
    const int dilation = k % 4;
    bool expected = false;
    for_each_around(voxel, dilation, [&](const VoxelIndex& at) { expected |= map.contains(at); });
    REQUIRE(map.contains_near(voxel, dilation) == expected);
  }
}

}  // namespace raymoval::raymoval_test
