// SPDX-License-Identifier: MIT
// The voxels of a static map and its memory.
#include <catch2/catch.hpp>

#include "methods/raymoval/static_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

TEST_CASE("a voxel that was erased is never filled again", "[raymoval]") {
  const VoxelIndex voxel(1, 2, 3), never(1, 2, 4);
  StaticMap map(0.2);
  map.integrate({voxel});
  map.erase(never);  // The voxel is empty.
  map.erase(voxel);
  map.integrate({voxel});
  CHECK_FALSE(map.occupied().contains(voxel));
  VoxelLookup found;
  map.look_up({voxel, never}, 1, found);
  CHECK(found.states == std::vector<VoxelState>{VoxelState::kErased, VoxelState::kEmpty});
}

TEST_CASE("a look-up finds brick and state of voxels near and far", "[raymoval]") {
  std::vector<VoxelIndex> places;
  for (const int x : {0, 1, 31, 32, -1, -32}) {
    for (const int y : {0, 1, 31, 32, -1, -32}) {
      for (const int z : {0, 1, 3, 4, -1, -4}) places.emplace_back(8 * x + 3, 8 * y + 5, 8 * z + 6);
    }
  }
  StaticMap map(0.2);
  VoxelLookup found;
  for (int round = 0; round < 3; ++round) {
    map.look_up(places, 1, found);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const VoxelState state = round == 0   ? VoxelState::kEmpty
                               : k % 2 == 1 ? VoxelState::kErased
                                            : VoxelState::kOccupied;
      REQUIRE(found.states[k] == state);
      REQUIRE(found.slots[k] == map.occupied().find_slot(OccupancyMap::brick_of(places[k])));
    }
    if (round == 0) map.integrate(places, found, Mask(places.size(), 0));
    for (std::size_t k = 1; k < places.size(); k += 2) map.erase(places[k]);
    CHECK(map.occupied().size() == places.size() / 2);
  }
}

TEST_CASE("points of new and old bricks in any order come into the map, dynamic ones do not",
          "[raymoval]") {
  const VoxelIndex origin(0, 0, 0), beside(1, 0, 0), far(80, 0, 0), farther(81, 0, 0);
  const std::vector<VoxelIndex> voxels = {far, origin, origin, farther, beside, {0, 0, 80}};
  StaticMap map(0.2);
  VoxelLookup found;
  map.look_up(voxels, 1, found);
  map.integrate(voxels, found, {0, 0, 0, 1, 0, 0});
  CHECK(map.occupied().size() == 4);
  for (const VoxelIndex& voxel : {far, origin, beside, VoxelIndex(0, 0, 80)}) {
    CHECK(map.occupied().contains(voxel));
  }
  // What is erased does not come back.
  map.erase(origin);
  map.look_up(voxels, 1, found);
  CHECK(found.states == std::vector<VoxelState>{VoxelState::kOccupied, VoxelState::kErased,
                                                VoxelState::kErased, VoxelState::kEmpty,
                                                VoxelState::kOccupied, VoxelState::kOccupied});
  map.integrate(voxels, found, Mask(6, 0));
  CHECK_FALSE(map.occupied().contains(origin));
  map.look_up({origin}, 1, found);
  CHECK(found.states == std::vector<VoxelState>{VoxelState::kErased});
  CHECK(map.occupied().contains(farther));
}

}  // namespace raymoval::raymoval_test
