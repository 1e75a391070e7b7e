// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "eval/points/cell_sort.h"

namespace raymoval {

TEST_CASE("cells are sorted by key and keep the order of their points", "[cell_sort]") {
  struct Shape {
    std::size_t points;
    int extent;  ///< Cells either way of the centre; many points share a cell if it is small.
    VoxelIndex centre;
  };
  const Shape shapes[] = {{100, 3, {0, 0, 0}},
                          {5000, 0, {7, -7, 0}},
                          {5000, 5, {0, 0, 0}},
                          {20000, 300, {-500000, 500000, 12}},
                          {20000, kVoxelLimit, {0, 0, 0}}};
  for (const Shape& shape : shapes) {
    CAPTURE(shape.points, shape.extent);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> offset(-shape.extent, shape.extent);
    std::vector<CellPoint> points;
    for (std::uint32_t i = 0; i < shape.points; ++i) {
      const VoxelIndex cell =
          shape.centre + VoxelIndex(offset(random), offset(random), offset(random));
      points.push_back({voxel_key(cell), i});
    }
    std::vector<CellPoint> expected = points;
    std::stable_sort(expected.begin(), expected.end(),
                     [](const CellPoint& a, const CellPoint& b) { return a.key < b.key; });
    sort_by_cell(points);
    CHECK(std::equal(points.begin(), points.end(), expected.begin(), expected.end(),
                     [](const CellPoint& a, const CellPoint& b) {
                       return a.key == b.key && a.point == b.point;
                     }));
  }
}

TEST_CASE("cells of a long, a wide and a high box are sorted by key", "[cell_sort]") {
  // Enough points for counting by digits, and extents that need 2, 7 and 12 bits.
  for (const VoxelIndex& extent :
       {VoxelIndex(3, 100, 4000), VoxelIndex(100, 4000, 3), VoxelIndex(4000, 3, 100)}) {
    std::mt19937 random(5);
    std::vector<CellPoint> points;
    for (std::uint32_t i = 0; i < 5000; ++i) {
      const auto below = [&](int end) { return static_cast<int>(random() % unsigned(end + 1)); };
      points.push_back({voxel_key(below(extent.x()), below(extent.y()), below(extent.z())), i});
    }
    std::vector<VoxelKey> expected;
    for (const CellPoint& point : points) expected.push_back(point.key);
    std::sort(expected.begin(), expected.end());
    sort_by_cell(points);
    std::vector<VoxelKey> sorted;
    for (const CellPoint& point : points) sorted.push_back(point.key);
    CHECK(sorted == expected);
  }
}

TEST_CASE("nothing to sort is no error", "[cell_sort]") {
  std::vector<CellPoint> none;
  sort_by_cell(none);
  CHECK(none.empty());
}

}  // namespace raymoval
