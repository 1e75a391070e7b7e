// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <tuple>

#include "eval/lattice/coarse_cells.h"

using namespace raymoval;

namespace {

CoarseCells coarse(const std::vector<VoxelIndex>& cells, double size) {
  return {1.0 / size, [&](const auto& visit) {
            for (const VoxelIndex& cell : cells) visit(cell);
          }};
}

Eigen::Vector3d middle(const VoxelIndex& cell, double size) {
  return (cell.cast<double>().array() + 0.5) * size;
}

}  // namespace

TEST_CASE("coarse cells never deny a cell, and deny those more than a cell away") {
  // Cells have 0.2 m, coarse ones two of them along each axis.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(-20, 20);
  std::vector<VoxelIndex> cells;
  std::set<std::tuple<int, int, int>> near;  // The cells, and those beside them.
  for (int i = 0; i < 40; ++i) {
    cells.emplace_back(place(random), place(random), place(random));
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          near.emplace(cells.back().x() + x, cells.back().y() + y, cells.back().z() + z);
        }
      }
    }
  }
  const CoarseCells coarse_cells = coarse(cells, 0.2);
  for (const VoxelIndex& cell : cells) {
    CHECK(coarse_cells.may_hold(middle(cell, 0.2)));
    // The lower corner belongs to the cell. Where it is rounded down, it is in the cell before.
    const Eigen::Vector3d corner = cell.cast<double>() * 0.2;
    const auto found = cell_index(corner, 1.0 / 0.2);
    if (found == cell) CHECK(coarse_cells.may_hold(corner));
  }
  int denied = 0;
  for (int z = -25; z <= 25; ++z) {
    for (int y = -25; y <= 25; ++y) {
      for (int x = -25; x <= 25; ++x) {
        const bool may_hold = coarse_cells.may_hold(middle({x, y, z}, 0.2));
        if (may_hold) REQUIRE(near.count({x, y, z}) == 1);
        denied += may_hold ? 0 : 1;
      }
    }
  }
  CHECK(denied > 130000);  // Of 132,651 cells, at most 320 are in the coarse cells.
}

TEST_CASE("coarse cells at both ends of the lattice take little memory, and hold their cells") {
  const VoxelIndex low = VoxelIndex::Constant(-kVoxelLimit + 1);
  const VoxelIndex high = VoxelIndex::Constant(kVoxelLimit - 1);
  const CoarseCells ends = coarse({low, high}, 0.2);
  CHECK(ends.may_hold(middle(low, 0.2)));
  CHECK(ends.may_hold(middle(high, 0.2)));
  CHECK_FALSE(ends.may_hold(Eigen::Vector3d::Zero()));
  // A point that no lattice holds is in no cell, and no error.
  CHECK_FALSE(ends.may_hold(Eigen::Vector3d(1e300, 0.0, 0.0)));
}

TEST_CASE("no coarse cells hold nothing") {
  CHECK_FALSE(CoarseCells().may_hold(Eigen::Vector3d(0.1, 0.1, 0.1)));
  CHECK_FALSE(coarse({}, 0.2).may_hold(Eigen::Vector3d(0.1, 0.1, 0.1)));
}
