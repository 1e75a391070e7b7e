// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "eval/lattice/cell_lattice.h"
#include "eval/lattice/ranked_bits.h"

namespace raymoval::test {

TEST_CASE("a lattice numbers its cells and finds no others", "[lattice]") {
  std::mt19937 random(3);
  for (const int extent : {3, 9, kVoxelLimit}) {
    CellSet cells;
    std::set<VoxelKey> expected;
    for (int i = 0; i < 500; ++i) {
      const auto index = [&] {
        return static_cast<int>(random() % static_cast<unsigned>(2 * extent + 1)) - extent;
      };
      const VoxelKey cell = voxel_key(index(), index(), index());
      cells.insert(cell);
      expected.insert(cell);
    }
    const CellLattice lattice(cells);
    REQUIRE(lattice.size() == expected.size());
    std::set<VoxelKey> seen;
    CellLattice::Number next = 0;
    CellLattice::Cursor cursor;
    lattice.for_each([&](CellLattice::Number number, VoxelKey cell) {
      CHECK(number == next++);
      CHECK(lattice.find(cell, cursor) == number);
      seen.insert(cell);
    });
    CHECK(seen == expected);
    for (const VoxelKey cell : expected) {
      CHECK(cells.contains(cell));
      for (int axis = 0; axis < 3; ++axis) {
        VoxelIndex beside = voxel_index(cell);
        if (++beside[axis] > kVoxelLimit) continue;
        const VoxelKey key = voxel_key(beside);
        CHECK(key == cell_beside(cell, axis == 0, axis == 1, axis == 2));
        CHECK((lattice.find(key, cursor) != CellLattice::kNone) == expected.contains(key));
        CHECK(cells.contains(key) == expected.contains(key));
      }
    }
  }
}

TEST_CASE("cells leave a set one by one", "[lattice]") {
  CellSet cells;
  const VoxelKey low = voxel_key(-1, -1, -1), high = voxel_key(-2, -1, -1);  // In one brick.
  cells.insert(low);
  cells.insert(high);
  cells.erase(low);
  cells.erase(voxel_key(40, 0, 0));  // Not there: no effect.
  CHECK_FALSE(cells.contains(low));
  CHECK(cells.contains(high));
  cells.insert(low);
  CHECK(cells.contains(low));
}

TEST_CASE("bits are counted through", "[lattice]") {
  std::mt19937 random(5);
  RankedBits bits(300);
  std::set<std::size_t> set;
  for (int i = 0; i < 90; ++i) {
    const std::size_t number = random() % 300;
    bits.set(number);
    set.insert(number);
  }
  bits.count_through();
  CHECK(bits.count() == set.size());
  std::uint32_t rank = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    CHECK(bits.test(i) == set.contains(i));
    CHECK(bits.rank(i) == rank);
    rank += set.contains(i) ? 1 : 0;
  }
  std::vector<std::size_t> visited;
  bits.for_each([&](std::uint32_t number) { visited.push_back(number); });
  CHECK(visited == std::vector<std::size_t>(set.begin(), set.end()));
}

}  // namespace raymoval::test
