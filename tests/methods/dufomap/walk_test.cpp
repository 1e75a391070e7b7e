// SPDX-License-Identifier: MIT
// Walks along lines that rounding treats worst: each ends after no more voxels than walls lie
// between its ends.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/common/scan_grid.h"
#include "methods/common/sparse_blocks.h"
#include "methods/dufomap/beams.h"
#include "tests/methods/grid_cells.h"
#include "tests/methods/held_scans.h"

namespace raymoval::dufomap_test {
using namespace raymoval::dufomap_method;

namespace {

/// Directions along axes and diagonals, each also with parts next to nothing.
std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> all;
  for (const double tiny : {0.0, 5e-324, -5e-324, 1e-310, -1e-308, 1e-200, -1e-17}) {
    for (int signs = 0; signs < 27; ++signs) {
      Eigen::Vector3d direction(signs % 3 - 1, signs / 3 % 3 - 1, signs / 9 - 1);
      if (direction.isZero()) continue;
      direction.normalize();
      for (double& part : direction) part = part == 0.0 ? tiny : part;
      all.push_back(direction);
    }
  }
  return all;
}

const std::vector<Eigen::Vector3d>& starts() {
  static const std::vector<Eigen::Vector3d> all = {
      {0, 0, 0}, {0.5, 0.5, 0.5}, {31.0, 32.0, 64.0}, {-1.0, 0.25, -64.0}, {-32, -32, -64}};
  return all;
}

}  // namespace

TEST_CASE("a beam marks no more voxels than walls lie on its way", "[dufomap]") {
  for (const Eigen::Vector3d& start : starts()) {
    for (const Eigen::Vector3d& direction : directions()) {
      for (const double length : {5e-324, 1e-162, 1e-9, 0.7, 41.3, 500.0}) {
        ScanGrid grid;
        const VoxelIndex last = FreeWalk(start, grid).mark_free(direction, length);
        const VoxelIndex first = voxel_index(start, 1.0);
        INFO(start.transpose() << " along " << direction.transpose() << ", " << length);
        const auto walls = static_cast<std::size_t>((last - first).cwiseAbs().sum());
        CHECK(toy::cells_of(grid, &Column::free).size() == walls + 1);
        CHECK(static_cast<double>(walls) <= length * direction.lpNorm<1>() + 3.0);
        const Eigen::Vector3d end = start + length * direction;
        CHECK((end - last.cast<double>().array().matrix()).minCoeff() > -1.001);
        CHECK((end - last.cast<double>().array().matrix()).maxCoeff() < 2.001);
      }
    }
  }
}

TEST_CASE("the longest beam ends", "[dufomap]") {
  ScanGrid grid;
  const VoxelIndex last =
      FreeWalk({0.5, 0.5, 0.5}, grid).mark_free({1.0, 0.0, 0.0}, FreeWalk::kLongest);
  CHECK(last.x() >= FreeWalk::kLongest - 1.0);
  CHECK(toy::cells_of(grid, &Column::free).size() <=
        static_cast<std::size_t>(FreeWalk::kLongest) + 1);
}

TEST_CASE("blocks anywhere are made once, found and removed", "[dufomap]") {
  SparseBlocks<int> blocks;
  CHECK(blocks.find({0, 0, 0}) == nullptr);
  for (int i = -3; i <= 3; ++i) CHECK(blocks.find_or_make({i, -i, 2 * i}, i) == i);
  CHECK(blocks.find_or_make({1, -1, 2}, 77) == 1);
  BlockFinder finder(blocks);
  for (int i = -3; i <= 3; ++i) CHECK(*finder.find({i, -i, 2 * i}) == i);
  CHECK(finder.find({0, 0, 1}) == nullptr);
  blocks.erase_if([](int value) { return value < 0; });
  int sum = 0;
  blocks.for_each([&](int value) { sum += value; });
  CHECK(sum == 6);
  CHECK(blocks.find({-1, 1, -2}) == nullptr);
}

}  // namespace raymoval::dufomap_test
