// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/common/scan_cells.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"
#include "core/simd/instruction_set_scope.h"

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

/// Whether roundings may put a number on either side of a whole one.
bool is_on_border(double number) {
  return std::abs(number - std::round(number)) < 1e-6;
}

}  // namespace

TEST_CASE("cells are those of the pose's product, by every instruction set and for any count",
          "[simd]") {
  const Eigen::Vector3d scale(2.5, 2.5, 20.0);
  for (const InstructionSet set : supported_instruction_sets()) {
    const InstructionSetScope scope(set);
    for (const std::size_t points : {0, 1, 3, 7, 8, 9, 20001}) {
      const Scan scan = turned_scan(points);
      ScanCells cells;
      find_cells(scan, scale, BesideCells::kParts, 2, cells);
      find_cells(scan, scale, BesideCells::kPartsAndHeight, 2, cells);
      REQUIRE(cells.size() == points);
      for (std::size_t k = 0; k < points; ++k) {
        const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
        REQUIRE(cells.height[k] == Approx(world.z()));
        for (int axis = 0; axis < 3; ++axis) {
          const double in_cells = world[axis] * scale[axis], cell = std::floor(in_cells);
          if (is_on_border(256.0 * in_cells)) continue;
          REQUIRE(cells[k][axis] == static_cast<int>(cell));
          const std::uint32_t part = cells.parts[k] >> (8 * axis) & 0xFFU;
          REQUIRE(part == static_cast<std::uint32_t>(256.0 * (in_cells - cell)));
        }
      }
    }
  }
}

TEST_CASE("a point beyond the lattice is an error, and not a wrong cell") {
  for (const float far : {4e5F, -4e5F}) {
    Scan scan = turned_scan(100);
    ScanCells cells;
    find_cells(scan, Eigen::Vector3d::Constant(5.0), BesideCells::kParts, 1, cells);
    scan.points[37].x() = far;
    CHECK_THROWS_AS(find_cells(scan, Eigen::Vector3d::Constant(5.0), BesideCells::kParts, 1, cells),
                    DataError);
    CHECK_THROWS_AS(find_cells(scan, {5.0, 5.0, 20.0}, BesideCells::kPartsAndHeight, 2, cells),
                    DataError);
  }
}

}  // namespace raymoval::raymoval_plus_test
