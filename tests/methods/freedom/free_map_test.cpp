// SPDX-License-Identifier: MIT
#include "methods/freedom/maps.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace raymoval::freedom_test {
using namespace raymoval::freedom_method;

namespace {

/// Rays that pass the voxels from `low` to `high`.
void pass(scan_grid::ScanGrid& grid, const VoxelIndex& low, const VoxelIndex& high) {
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        grid.column({x, y, z}).free |= scan_grid::bit_of({x, y, z});
      }
    }
  }
}

std::vector<VoxelIndex> passed(FreeMap& map, const VoxelIndex& low, const VoxelIndex& high) {
  scan_grid::ScanGrid grid;
  pass(grid, low, high);
  return map.count_passes(grid);
}

/// A scan with a point in the middle of a voxel of 0.4 m. @return the level it gets
Level hit(FreeMap& map, const VoxelIndex& voxel) {
  Scan scan;
  scan.points.push_back(((voxel.cast<double>().array() + 0.5) * 0.4).matrix().cast<float>());
  Parameters all;
  all.minimum_range = 0.0;
  ScanMap voxels;
  voxels.fill(scan, all);
  map.count_hits(voxels);
  return voxels.voxels().at(0).level;
}

Parameters counts(int to_free, int to_revert = 20) {
  Parameters parameters;
  parameters.counts_to_free = to_free;
  parameters.counts_to_revert = to_revert;
  return parameters;
}

const VoxelIndex kMiddle(7, -8, 0);  ///< At the corner of a block, whose neighbours lie in eight.
const VoxelIndex kOne(1, 1, 1);

}  // namespace

TEST_CASE("freedom: a voxel is free once it and its neighbours were passed often enough") {
  FreeMap map(counts(3));
  const VoxelIndex low = kMiddle - kOne, high = kMiddle + kOne;
  CHECK(passed(map, low, high).empty());
  CHECK(passed(map, low, high).empty());
  CHECK(passed(map, low, high) == std::vector<VoxelIndex>{kMiddle});  // The only one with all 26.
  CHECK(map.is_free(kMiddle));
  CHECK_FALSE(map.is_free(low));
  CHECK(passed(map, low, high).empty());  // It is listed once.
}

TEST_CASE("freedom: one neighbour that was hit keeps a voxel from being free") {
  for (int i = 0; i < 27; ++i) {
    const VoxelIndex offset(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
    if (offset == VoxelIndex::Zero()) continue;
    FreeMap map(counts(3));
    CAPTURE(i);
    CHECK(passed(map, kMiddle - kOne, kMiddle + kOne).empty());
    CHECK(passed(map, kMiddle - kOne, kMiddle + kOne).empty());
    CHECK(hit(map, kMiddle + offset) == Level::kStatic);
    CHECK(passed(map, kMiddle - kOne, kMiddle + kOne).empty());
    CHECK(passed(map, kMiddle - kOne, kMiddle + kOne).empty());
    CHECK(passed(map, kMiddle - kOne, kMiddle + kOne).size() == 1);  // The third after the hit.
  }
}

TEST_CASE("freedom: rays do not pass what their own scan hits") {
  scan_grid::ScanGrid grid;
  pass(grid, kMiddle - kOne, kMiddle + kOne);
  grid.column(kMiddle).hit |= scan_grid::bit_of(kMiddle);
  FreeMap map(counts(1));
  CHECK(map.count_passes(grid).empty());
}

TEST_CASE("freedom: free space that is hit scan after scan is free no more") {
  FreeMap map(counts(2, 3));
  const VoxelIndex low = kMiddle - 2 * kOne, high = kMiddle + 2 * kOne;
  passed(map, low, high);
  CHECK(passed(map, low, high).size() == 27);
  const VoxelIndex beside = kMiddle + VoxelIndex(1, 0, 0);
  CHECK(hit(map, kMiddle) == Level::kConservative);
  CHECK(hit(map, kMiddle) == Level::kConservative);
  CHECK(map.is_free(kMiddle));
  CHECK(hit(map, kMiddle) == Level::kConservative);  // It was classified before.
  CHECK_FALSE(map.is_free(kMiddle));
  CHECK_FALSE(map.is_free(beside));
  CHECK(hit(map, kMiddle) == Level::kStatic);
  // The voxel counts from 0 again. Its neighbours keep their counts: they could be free after one
  // more scan, but the middle voxel prevents it.
  CHECK(passed(map, low, high).empty());
  CHECK(passed(map, low, high).size() == 27);
}

TEST_CASE("freedom: neighbours of a reverted voxel keep their counts") {
  FreeMap map(counts(3, 1));
  const VoxelIndex low = kMiddle - 2 * kOne, high = kMiddle + 2 * kOne;
  for (int i = 0; i < 3; ++i) passed(map, low, high);
  hit(map, kMiddle);
  // Rays pass the middle alone three times, then all once.
  for (int i = 0; i < 3; ++i) passed(map, kMiddle, kMiddle);
  CHECK(passed(map, low, high).size() == 26);
}

TEST_CASE("freedom: in a block that is all free no passes count") {
  FreeMap map(counts(1, 2));
  const VoxelIndex low(-1, -1, -1), high(8, 8, 8), inside(3, 3, 3);
  CHECK(passed(map, low, high).size() == 512);
  hit(map, inside);
  passed(map, low, high);  // Would end the run of hits.
  hit(map, inside);
  CHECK_FALSE(map.is_free(inside));
}

TEST_CASE("freedom: hits count only in blocks that rays have passed") {
  FreeMap map(counts(1, 1));
  CHECK(hit(map, {100, 0, 0}) == Level::kStatic);
  CHECK_FALSE(map.is_free({100, 0, 0}));
}

TEST_CASE("freedom: rays stop before what the scan hits and before their end") {
  Parameters parameters;
  Scan scan;
  scan.T_world_sensor.translation() << 0.2, 0.2, 0.2;
  scan.points = {{4.0F, 0.0F, 0.0F}, {8.0F, 0.0F, 0.0F}};  // Voxels 10 and 20; the first hides one.
  ScanMap voxels;
  voxels.fill(scan, parameters);
  const auto passed_along_x = [&](const std::vector<Eigen::Vector3d>& hole_ends) {
    scan_grid::ScanGrid grid;
    cast_rays(scan, voxels, hole_ends, parameters, grid);
    std::string row;
    for (int x = -1; x < 22; ++x) {
      const auto& column = grid.column({x, 0, 0});
      row += (column.hit & 1) != 0 ? '#' : ((column.free & 1) != 0 ? '.' : ' ');
    }
    return row;
  };
  CHECK(passed_along_x({}) == " ..........#         # ");
  SECTION("a ray without a return passes its last voxel but one") {
    scan.points.clear();
    voxels.fill(scan, parameters);
    CHECK(passed_along_x({{2.0, 0.0, 0.0}}) == " .....                 ");
    CHECK(passed_along_x({{0.1, 0.0, 0.0}}) == "                       ");  // Ends where it starts.
    CHECK(passed_along_x({{0.0, 0.0, 0.0}}) == "                       ");
  }
  SECTION("a ray is cut at its range and heights") {
    scan.points = {{40.0F, 0.0F, 0.0F}};
    voxels.fill(scan, parameters);
    parameters.ray_range = 2.0;
    CHECK(passed_along_x({}) == " .....                 ");
    // One metre up on 40 m: it ends at 0.05 m, after 2 m.
    scan.points = {{40.0F, 0.0F, 1.0F}};
    voxels.fill(scan, parameters);
    parameters.ray_range = 80.0;
    parameters.ray_highest = 0.05;
    CHECK(passed_along_x({}) == " .....                 ");
    scan.points = {{40.0F, 0.0F, -1.0F}};
    voxels.fill(scan, parameters);
    parameters.ray_lowest = -0.05;
    CHECK(passed_along_x({}) == " .....                 ");
  }
}

}  // namespace raymoval::freedom_test
