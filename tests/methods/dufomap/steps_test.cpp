// SPDX-License-Identifier: MIT
// The five steps, each on a scene small enough for pencil and paper. Voxels of 0.1 m; by default
// the sensor is in the middle of voxel (0, 0, 0).
#include <algorithm>
#include <catch2/catch.hpp>

#include "methods/dufomap/beams.h"
#include "tests/methods/dufomap/oracle.h"
#include "tests/methods/grid_cells.h"
#include "tests/methods/held_scans.h"

namespace raymoval::dufomap_test {
using namespace raymoval::dufomap_method;

namespace {

/// Steps 1-3 for points in the middle of voxels.
struct Cast {
  ScanGrid grid;
  std::vector<VoxelIndex> ends;

  Cast(const std::vector<VoxelIndex>& points, const Parameters& parameters = {}) {
    toy::HeldScans scans;
    std::vector<Eigen::Vector3d> world;
    for (const VoxelIndex& p : points) world.push_back(centre(p.x(), p.y(), p.z()));
    scans.add_world(centre(0, 0, 0), world);
    const Scan scan = scans.load(0);
    const auto voxels = voxels_of(scan, parameters.voxel_size);
    ends = beam_ends(scan, voxels, parameters, grid);
    cast_beams(scan, ends, parameters, grid);
  }
  bool hit(int x, int y, int z) {
    const VoxelIndex voxel(x, y, z);
    return (grid.column(voxel).hit & bit_of(voxel)) != 0;
  }
  bool free(int x, int y, int z) {
    const VoxelIndex voxel(x, y, z);
    return (grid.column(voxel).free & bit_of(voxel)) != 0;
  }
  /// Free voxels on the positive x axis, which must be the first ones.
  int free_along_x() {
    int count = 0;
    while (free(count, 0, 0)) ++count;
    for (int x = count; x < 100; ++x) CHECK_FALSE(free(x, 0, 0));
    return count;
  }
};

Parameters with(double d_s, int d_p) {
  Parameters parameters;
  parameters.hit_extension = d_s;
  parameters.unknown_inflation = d_p;
  return parameters;
}

}  // namespace

TEST_CASE("step 1: one beam per voxel, none for near points") {
  toy::HeldScans scans;
  // Two points of voxel (10, 0, 0), one of its neighbour, one 0.15 m and one 0.23 m away.
  scans.add_world(centre(0, 0, 0), {{1.02, 0.05, 0.05},
                                    {1.08, 0.02, 0.05},
                                    {1.12, 0.05, 0.05},
                                    {0.05, 0.2, 0.05},
                                    {0.05, 0.28, 0.05}});
  const Scan scan = scans.load(0);
  ScanGrid grid;
  const auto voxels = voxels_of(scan, 0.1);
  auto ends = beam_ends(scan, voxels, Parameters{}, grid);
  REQUIRE(ends.size() == 3);
  const auto has = [&](const VoxelIndex& voxel) {
    return std::find(ends.begin(), ends.end(), voxel) != ends.end();
  };
  CHECK(has({10, 0, 0}));
  CHECK(has({11, 0, 0}));
  CHECK(has({0, 2, 0}));
  CHECK(toy::cells_of(grid, &Column::free).empty());
}

TEST_CASE("step 2: a hit reaches back along its beam") {
  // From the middle of voxel 10 back by 2 voxels: walls at 0.5 and 1.5 voxels, so 9 and 8 as well.
  Cast cast({{10, 0, 0}});
  for (int x = -3; x < 15; ++x) CHECK(cast.hit(x, 0, 0) == (x >= 8 && x <= 10));
  Cast bare({{10, 0, 0}}, with(0.0, 1));
  for (int x = -3; x < 15; ++x) CHECK(bare.hit(x, 0, 0) == (x == 10));
  // The other way and downwards.
  Cast back({{0, 0, -10}});
  for (int z = -15; z < 3; ++z) CHECK(back.hit(0, 0, z) == (z >= -10 && z <= -8));
}

TEST_CASE("step 3: free up to the first hit entered, and d_p voxels on") {
  CHECK(Cast({{10, 0, 0}}, with(0.2, 0)).free_along_x() == 9);   // 0 .. 8, where the hits begin.
  CHECK(Cast({{10, 0, 0}}, with(0.2, 1)).free_along_x() == 10);  // One more,
  CHECK(Cast({{10, 0, 0}}, with(0.2, 2)).free_along_x() == 11);  // two more,
  CHECK(Cast({{10, 0, 0}}, with(0.0, 2)).free_along_x() == 13);  // also behind the surface.
  Parameters plain = with(0.2, 2);
  plain.compensate_inflation = false;
  CHECK(Cast({{10, 0, 0}}, plain).free_along_x() == 9);
}

TEST_CASE("step 3: a beam ends at the hits of another beam") {
  CHECK(Cast({{10, 0, 0}, {30, 0, 0}}).free_along_x() == 10);
}

TEST_CASE("step 3: nothing is free beyond the maximum range") {
  Parameters near = with(0.2, 1);
  near.maximum_range = 0.7;  // 7 voxels from the middle of voxel 0: the last wall is at 6.5.
  CHECK(Cast({{30, 0, 0}}, near).free_along_x() == 9);  // 0 .. 7, and one for the compensation.
}

TEST_CASE("step 3: the compensation counts along the axis last stepped") {
  // From the middle of (20, 10, 0) on with slope 1 : 2, x walls come after 0.25, 0.75 ..., y walls
  // after 0.5, 1.5 ... of the distance in which y grows by 1: (21, 10), (21, 11), (22, 11), ...
  Cast one({{20, 10, 0}}, with(0.0, 1));
  CHECK(one.free(20, 10, 0));
  CHECK(one.free(21, 10, 0));
  CHECK_FALSE(one.free(21, 11, 0));
  Cast two({{20, 10, 0}}, with(0.0, 2));
  CHECK(two.free(21, 10, 0));
  CHECK(two.free(21, 11, 0));
  CHECK(two.free(22, 11, 0));
  CHECK_FALSE(two.free(23, 11, 0));
  CHECK_FALSE(two.free(22, 12, 0));
}

TEST_CASE("step 3: beams pass from block to block in all directions") {
  // Blocks end at 0 along each axis, at +-64 in z and at +-32 in x and y: all eight diagonals, one
  // at a time. |x| : |y| : |z| = 90 : 70 : 150 crosses each kind of wall. The beam is one voxel
  // wide and each of its steps is to a face neighbour, so that their number is the sum of the three
  // differences: up to the end, and one for d_p.
  for (int octant = 0; octant < 8; ++octant) {
    const VoxelIndex end((octant & 1) != 0 ? 90 : -90, (octant & 2) != 0 ? 70 : -70,
                         (octant & 4) != 0 ? 151 : -151);
    Cast cast({end}, with(0.0, 1));
    CHECK(cast.free(end.x(), end.y(), end.z()));
    CHECK(toy::cells_of(cast.grid, &Column::free).size() == 1 + 90 + 70 + 151 + 1);
  }
}

namespace {

/// Voids of a scan whose free voxels are a cube of side 5 around `middle`, less one, with one hit.
Mask voids_of_cube(const VoxelIndex& middle, int d_p, const std::vector<VoxelIndex>& missing,
                   const std::vector<VoxelIndex>& hits, std::vector<VoxelIndex>& asked) {
  ScanGrid grid;
  asked.clear();
  for (int n = 0; n < 125; ++n) {
    const VoxelIndex offset(n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2);
    const VoxelIndex voxel = middle + offset;
    asked.push_back(offset);
    if (std::find(missing.begin(), missing.end(), offset) != missing.end()) continue;
    grid.column(voxel).free |= bit_of(voxel);
  }
  for (const VoxelIndex& hit : hits) {
    grid.column(middle + hit).hit |= bit_of(middle + hit);
  }
  ScanVoids found;
  find_voids(grid, d_p, found);
  VoidMap map;
  map.add(found);
  std::vector<VoxelIndex> voxels;
  for (const VoxelIndex& offset : asked) voxels.push_back(middle + offset);
  return map.contain(voxels);
}

}  // namespace

TEST_CASE("step 4: a void is free with all its neighbours and no hit") {
  std::vector<VoxelIndex> asked;
  // In the middle of a block, and over its corners: blocks begin at multiples of 32 and of 64.
  for (const VoxelIndex& middle : {VoxelIndex(10, 10, 20), VoxelIndex(0, 0, 0),
                                   VoxelIndex(-32, 32, 64), VoxelIndex(31, -1, -65)}) {
    for (int d_p = 0; d_p <= 2; ++d_p) {
      const Mask voids = voids_of_cube(middle, d_p, {}, {}, asked);
      for (std::size_t k = 0; k < asked.size(); ++k) {
        CHECK(voids[k] == (asked[k].cwiseAbs().maxCoeff() <= 2 - d_p ? 1 : 0));
      }
    }
    // Without the corner (2, 2, 2) its neighbour (1, 1, 1) is none; a hit in the middle is none.
    const Mask voids = voids_of_cube(middle, 1, {{2, 2, 2}}, {{0, 0, 0}}, asked);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const bool inner = asked[k].cwiseAbs().maxCoeff() <= 1;
      const bool expected = inner && asked[k] != VoxelIndex(1, 1, 1) && !asked[k].isZero();
      CHECK(voids[k] == (expected ? 1 : 0));
    }
  }
}

TEST_CASE("step 5: voids of several scans are united") {
  VoidMap map;
  VoidBits first{}, second{};
  first[3] = 1;
  second[3] = 2;
  map.add({{{-1, 2, 0}, first}});
  map.add({{{-1, 2, 0}, second}});
  const int x = -kSide, y = 2 * kSide + 3;
  CHECK(map.contain({{x, y, 0}, {x, y, 1}, {x, y, 2}, {x, y + 1, 0}, {x + 90, y, 0}}) ==
        Mask{1, 1, 0, 0, 0});
}

}  // namespace raymoval::dufomap_test
