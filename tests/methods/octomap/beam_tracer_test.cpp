// SPDX-License-Identifier: MIT
#include "methods/octomap/beam_tracer.h"

#include <octomap/OcTree.h>

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>
#include <set>

namespace raymoval::octomap_test {
using namespace raymoval::octomap_method;

namespace {

std::set<CellCode> free_cells(const CellBlocks& cells) {
  std::set<CellCode> codes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t bit = 0; bit < 512; ++bit) {
      if ((cells.content(i).free[bit / 64] >> bit % 64 & 1) != 0) {
        codes.insert(cells.name(i) << kBlockBits | bit);
      }
    }
  }
  return codes;
}

std::set<CellCode> traced(double resolution, const octomap::point3d& origin,
                          const octomap::point3d& end) {
  const CellLattice lattice(resolution);
  CellBlocks cells;
  const auto last = lattice.cell_of(end);
  if (last) BeamTracer(lattice, origin).mark_free(end, *last, cells);
  return free_cells(cells);
}

std::set<CellCode> traced_by_library(octomap::OcTree& tree, const octomap::point3d& origin,
                                     const octomap::point3d& end) {
  octomap::KeyRay ray;
  std::set<CellCode> codes;
  if (!tree.computeRayKeys(origin, end, ray)) return codes;
  for (const octomap::OcTreeKey& key : ray) codes.insert(cell_code(key[0], key[1], key[2]));
  return codes;
}

}  // namespace

TEST_CASE("a cell code interleaves the keys, x lowest") {
  CHECK(cell_code(1, 0, 0) == 1);
  CHECK(cell_code(0, 1, 0) == 2);
  CHECK(cell_code(0, 0, 1) == 4);
  CHECK(cell_code(3, 0, 2) == (1 | 8 | 32));
  CHECK(cell_code(0xFFFF, 0xFFFF, 0xFFFF) == (CellCode{1} << 48) - 1);
  CHECK(gather_bits(spread_bits(0xA5C3)) == 0xA5C3);
}

TEST_CASE("a block keeps what was put in it when the table grows") {
  CellBlocks cells;
  for (CellCode i = 0; i < 20000; ++i) cells.occupy(i * 7919 % 1000003 << kBlockBits | i % 512);
  std::size_t bits = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const std::uint64_t word : cells.content(i).occupied) {
      bits += static_cast<std::size_t>(std::popcount(word));
    }
  }
  CHECK(bits == 20000);  // 7919 and 1000003 are primes: all blocks differ.
  CHECK(cells.size() == 20000);
}

TEST_CASE("cells are half open and negative ones are found by floor") {
  const CellLattice lattice(0.2);
  const auto key_of = [&](float x) {
    return gather_bits(*lattice.cell_of({x, 0.1F, 0.1F})) - 32768;
  };
  CHECK(key_of(0.1F) == 0);
  CHECK(key_of(-0.1F) == -1);
  CHECK(key_of(-0.3F) == -2);
  // 1.4 is 1.39999998 in float: the sixth cell, not the seventh.
  CHECK(key_of(1.4F) == 6);
  CHECK_FALSE(lattice.cell_of({6553.7F, 0, 0}).has_value());
  CHECK_FALSE(lattice.cell_of({0, -6553.7F, 0}).has_value());
  CHECK(lattice.cell_of({6553.5F, -6553.5F, 0}).has_value());
  CHECK_FALSE(lattice.cell_of({std::numeric_limits<float>::quiet_NaN(), 0, 0}).has_value());
}

TEST_CASE("a tie between two walls goes to the later axis") {
  // From the middle of cell (0, 0, 0) to that of (2, 2, 0) along the diagonal.
  const std::set<CellCode> expected{cell_code(32768, 32768, 32768), cell_code(32768, 32769, 32768),
                                    cell_code(32769, 32769, 32768), cell_code(32769, 32770, 32768)};
  CHECK(traced(0.2, {0.1F, 0.1F, 0.1F}, {0.5F, 0.5F, 0.1F}) == expected);
}

TEST_CASE("an end in the origin's cell frees nothing") {
  CHECK(traced(0.2, {0.1F, 0.1F, 0.1F}, {0.15F, 0.02F, 0.19F}).empty());
}

TEST_CASE("beams cross the very cells that computeRayKeys gives") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> near(-1.0F, 1.0F);
  for (const double resolution : {0.05, 0.1, 0.2, 0.37}) {
    octomap::OcTree tree(resolution);
    for (int i = 0; i < 1500; ++i) {
      const float reach = i % 3 == 0 ? 2.0F : 70.0F;
      octomap::point3d origin(near(random), near(random), near(random));
      octomap::point3d end(reach * near(random), reach * near(random), reach * near(random));
      // Along an axis, and from and to cell walls, where rounding decides.
      if (i % 5 == 0) end.y() = origin.y();
      if (i % 10 == 0) end.z() = origin.z();
      if (i % 7 == 0) origin = {0.2F, -0.4F, 1.0F};
      if (i % 11 == 0) end = {std::round(end.x()), std::round(end.y()), std::round(end.z())};
      INFO(resolution << ": " << origin << " to " << end);
      REQUIRE(traced(resolution, origin, end) == traced_by_library(tree, origin, end));
    }
  }
}

namespace {

std::array<int, 3> keys_of(CellCode cell) {
  return {gather_bits(cell), gather_bits(cell >> 1), gather_bits(cell >> 2)};
}

/// Checks that a walk stays in the box of its two ends, of which only the last cell is not marked,
/// and passes through no more cells than walls lie between these.
void check_bounded(double resolution, const octomap::point3d& origin, const octomap::point3d& end) {
  const CellLattice lattice(resolution);
  const CellCode first = *lattice.cell_of(origin), last = *lattice.cell_of(end);
  const std::set<CellCode> cells = traced(resolution, origin, end);
  INFO(resolution << ": " << origin << " to " << end);
  if (first == last) {
    CHECK(cells.empty());
    return;
  }
  std::size_t walls = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    walls += static_cast<std::size_t>(std::abs(keys_of(last)[axis] - keys_of(first)[axis]));
  }
  CHECK(cells.contains(first));
  CHECK_FALSE(cells.contains(last));
  CHECK(cells.size() <= walls + 3);  // Rounding may pass beside the last cell.
}

}  // namespace

TEST_CASE("a beam too short to be squared ends, wherever its sensor stands") {
  // The sensor of the first scan stands in the tree's centre, on walls along all axes.
  for (const double resolution : {0.05, 0.1, 0.2, 0.25, 0.37}) {
    for (const float length : {1e-45F, 1e-38F, 1e-27F, 1e-23F, 1e-20F, 1e-18F, 1e-15F, 1e-9F}) {
      for (int signs = 0; signs < 27; ++signs) {
        const octomap::point3d end(length * static_cast<float>(signs % 3 - 1),
                                   length * static_cast<float>(signs / 3 % 3 - 1),
                                   length * static_cast<float>(signs / 9 - 1));
        check_bounded(resolution, {0.0F, 0.0F, 0.0F}, end);
        check_bounded(resolution, {0.0F, 0.0F, 1.0F}, end + octomap::point3d(0.0F, 0.0F, 1.0F));
      }
    }
  }
  // The beam crosses one wall, or three through a corner, where walls and halves of cells are
  // exact.
  CHECK(traced(0.25, {0, 0, 0}, {-1e-27F, 0, 0}) == std::set{cell_code(32768, 32768, 32768)});
  CHECK(traced(0.25, {0, 0, 0}, {-1e-27F, -1e-27F, -1e-27F}).size() == 3);
}

TEST_CASE("beams through corners, along axes and across the whole tree end", "[slow]") {
  for (const float far : {6553.4F, 100.0F, 0.6F}) {
    for (int signs = 0; signs < 27; ++signs) {
      const octomap::point3d to(far * static_cast<float>(signs % 3 - 1),
                                far * static_cast<float>(signs / 3 % 3 - 1),
                                far * static_cast<float>(signs / 9 - 1));
      check_bounded(0.2, {0, 0, 0}, to);
      check_bounded(0.2, to * -1.0F, to);
      check_bounded(0.2, {0.1F, 0.1F, 0.1F}, to);
      check_bounded(0.2, {0, 1e-42F, -1e-42F}, to);
    }
  }
}

TEST_CASE("a beam from or to a place outside the tree frees nothing") {
  CHECK(traced(0.2, {7000.0F, 0, 0}, {6000.0F, 0, 0}).empty());
  CHECK(traced(0.2, {6000.0F, 0, 0}, {7000.0F, 0, 0}).empty());
}

}  // namespace raymoval::octomap_test
