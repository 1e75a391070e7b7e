// SPDX-License-Identifier: MIT
#include "eval/lattice/mean_table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace raymoval;

TEST_CASE("a table's means are those of first points and offsets, bit by bit", "[lattice]") {
  // More cells than points for some, so that some stay empty: also the first and the last one.
  constexpr std::size_t kCells = 50;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-5e5, 5e5);
  MeanTable table(kCells);
  std::vector<std::vector<Eigen::Vector3d>> points(kCells);
  for (int i = 0; i < 400; ++i) {
    const std::size_t cell = 1 + random() % (kCells - 2);
    if (cell % 7 == 0) continue;
    const Eigen::Vector3d point(place(random), place(random), place(random));
    points[cell].push_back(point);
    table.add(cell, point);
  }
  std::size_t filled = 0;
  for (const auto& of_cell : points) filled += of_cell.empty() ? 0 : 1;
  CHECK(table.finish() == filled);
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    if (points[cell].empty()) {
      CHECK(std::isnan(table.mean(cell).x()));
      continue;
    }
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : points[cell]) sum += point - points[cell].front();
    const Eigen::Vector3d mean =
        points[cell].front() + sum / static_cast<double>(points[cell].size());
    CHECK(table.mean(cell) == mean);
  }
}

TEST_CASE("a table without cells, or with empty ones, is finished as well", "[lattice]") {
  CHECK(MeanTable(0).finish() == 0);
  MeanTable one(1);
  one.add(0, {1.0, 2.0, 3.0});
  CHECK(one.finish() == 1);
  CHECK(one.mean(0) == Eigen::Vector3d(1.0, 2.0, 3.0));
}
