// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_rows.h"

#include <catch2/catch.hpp>

#include "tests/benchmark/clean/recorded_scans.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// The cells of points on the x axis with an intensity and a ring each.
PointRecords cells_of(const std::vector<std::array<double, 3>>& points, double size) {
  VoxelRows cells(driver_layout(), size, Eigen::Vector3d::Zero());
  for (const auto& [x, intensity, ring] : points) {
    const ScanRows one{records_of(driver_layout(), {{x, 0.25, 0.25, intensity, ring, 0}}),
                       {{x, 0.25, 0.25}}};
    cells.add(one, 0);
  }
  PointRecords all{driver_layout(), {}};
  cells.take([&](const ScanRows& piece) {
    all.bytes.insert(all.bytes.end(), piece.rows.bytes.begin(), piece.rows.bytes.end());
    CHECK(piece.rows.size() == piece.world.size());
  });
  return all;
}

}  // namespace

TEST_CASE("A cell has the mean position and intensity, and the rest of its most central point") {
  // 10.1, 10.2 and 10.45 share [10, 10.5), whose middle is 10.25; 15 is a cell of its own.
  const PointRecords cells =
      cells_of({{15, 1, 4}, {10.1, 0.1, 1}, {10.2, 0.2, 2}, {10.45, 0.6, 3}}, 0.5);
  REQUIRE(cells.size() == 2);
  CHECK(value_of(cells, 0, "x") == Approx(10.25));
  CHECK(value_of(cells, 0, "intensity") == Approx(0.3));
  CHECK(value_of(cells, 0, "ring") == 2.0);
  CHECK(value_of(cells, 1, "x") == Approx(15.0));
  CHECK(value_of(cells, 1, "ring") == 4.0);
}

TEST_CASE("The order of points does not change a cell") {
  const PointRecords there = cells_of({{10.1, 0.1, 1}, {10.2, 0.2, 2}, {10.45, 0.6, 3}}, 0.5);
  const PointRecords back = cells_of({{10.45, 0.6, 3}, {10.2, 0.2, 2}, {10.1, 0.1, 1}}, 0.5);
  CHECK(value_of(there, 0, "ring") == value_of(back, 0, "ring"));
  CHECK(value_of(there, 0, "x") == Approx(value_of(back, 0, "x")));
}
