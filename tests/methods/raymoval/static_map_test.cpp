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

}  // namespace raymoval::raymoval_test
