// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/scan_cells.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

Scan turned_scan(std::size_t points) {
  std::mt19937 random(static_cast<unsigned>(points) + 1);
  std::normal_distribution<float> place(0.0F, 30.0F);
  Scan scan;
  scan.T_world_sensor = Eigen::Translation3d(-300.0, 1200.0, 4.0) *
                        Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.1, -0.2, 3.0).normalized());
  for (std::size_t k = 0; k < points; ++k) {
    scan.points.emplace_back(place(random), place(random), 0.1F * place(random));
  }
  return scan;
}

}  // namespace

TEST_CASE("cells are those of the pose's product") {
  const Eigen::Vector3d scale(2.5, 2.5, 20.0);
  const Scan scan = turned_scan(20001);
  ScanCells cells;
  find_cells(scan, scale, BesideCells::kPartsAndHeight, 2, cells);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
    REQUIRE(cells.height[k] == Approx(world.z()));
    for (int axis = 0; axis < 3; ++axis) {
      const double in_cells = world[axis] * scale[axis], cell = std::floor(in_cells);
      const double parts = 256.0 * (in_cells - cell);
      if (std::abs(parts - std::round(parts)) < 1e-6) continue;  // They may round to either side.
      REQUIRE(cells[k][axis] == static_cast<int>(cell));
      REQUIRE((cells.parts[k] >> (8 * axis) & 0xFFU) == static_cast<std::uint32_t>(parts));
    }
  }
}

TEST_CASE("a point beyond the lattice is an error, and not a wrong cell") {
  for (const float far : {4e5F, -4e5F}) {
    Scan scan = turned_scan(100);
    ScanCells cells;
    scan.points[37].x() = far;
    CHECK_THROWS_AS(find_cells(scan, Eigen::Vector3d::Constant(5.0), BesideCells::kParts, 1, cells),
                    DataError);
    CHECK_THROWS_AS(find_cells(scan, {5.0, 5.0, 20.0}, BesideCells::kPartsAndHeight, 2, cells),
                    DataError);
  }
}

}  // namespace raymoval::raymoval_plus_test
