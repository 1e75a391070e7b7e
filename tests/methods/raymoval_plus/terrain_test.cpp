// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/terrain.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// The cells of some points of the world.
ScanCells cells_of(const Terrain& terrain, const std::vector<Eigen::Vector3d>& points) {
  Scan scan;
  for (const Eigen::Vector3d& point : points) scan.points.push_back(point.cast<float>());
  ScanCells cells;
  terrain.find_cells_of(scan, 1, cells);
  return cells;
}

Terrain terrain_of(const std::vector<Eigen::Vector3d>& points) {
  Terrain terrain{Parameters{}};
  terrain.add(cells_of(terrain, points), RunContext{});
  terrain.update(RunContext{});
  return terrain;
}

std::vector<float> heights_of(const Terrain& terrain, const std::vector<Eigen::Vector3d>& points,
                              int threads = 1) {
  std::vector<float> heights;
  terrain.find_heights(cells_of(terrain, points), RunContext{.threads = threads}, heights);
  return heights;
}

float height_of(const Terrain& terrain, const Eigen::Vector3d& point) {
  return heights_of(terrain, {point})[0];
}

}  // namespace

TEST_CASE("ground is the low quantile, without pits and walls") {
  CHECK(std::isinf(height_of(Terrain{Parameters{}}, {0.1, 0.1, -1.7})));
  std::vector<Eigen::Vector3d> points;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) {
      for (int k = 0; k < 4; ++k) {
        const double z = x == 5 && y == 5 ? -3.0 : -1.7;  // one column of false echoes
        points.emplace_back(0.4 * x + 0.05 + 0.08 * k, 0.4 * y + 0.2, z);
      }
    }
  }
  const Terrain terrain = terrain_of(points);
  CHECK(height_of(terrain, {0.1, 0.1, -1.7}) == Approx(0.0).margin(0.05));
  CHECK(height_of(terrain, {2.2, 2.2, 0.3}) == Approx(2.0).margin(0.3));  // in the pit
  CHECK(std::isinf(height_of(terrain, {100.0, 0.0, 0.0})));
}

TEST_CASE("under a roof the ground rises no more than the slope allows") {
  // Columns are 0.4 m. Ground at 0 m up to x = 4 m; from there on all returns come from a roof at 2
  // m.
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x < 20; ++x) {
    for (int y = -10; y < 10; ++y) {
      for (int k = 0; k < 3; ++k) points.emplace_back(0.4 * x + 0.2, 0.4 * y + 0.2, x < 10 ? 0 : 2);
    }
  }
  const Terrain terrain = terrain_of(points);
  CHECK(height_of(terrain, {3.8, 0.2, 0.0}) == Approx(0.0).margin(0.05));
  // From column to column beyond the last one of ground it may rise by 0.04 m.
  CHECK(height_of(terrain, {4.2, 0.2, 2.0}) == Approx(1.96).margin(0.01));
  CHECK(height_of(terrain, {5.0, 0.2, 2.0}) == Approx(1.88).margin(0.01));
  CHECK(height_of(terrain, {5.4, 0.2, 2.0}) == Approx(1.84).margin(0.01));
}

TEST_CASE(
    "on steep land heights are those above a plane, and things stand on it as on level land") {
  // A box of 2 x 2 m with returns only above half a metre, on land that rises in some direction.
  const auto is_box = [](double x, double y) { return std::abs(x) < 1.0 && std::abs(y) < 1.0; };
  for (const auto& [slope_x, slope_y] :
       {std::pair(0.0, 0.0), std::pair(0.5, 0.0), std::pair(-0.3, 0.4), std::pair(0.0, -0.6)}) {
    // A hundred points in each column.
    std::vector<Eigen::Vector3d> points, road, box;
    for (int n = -400; n < 400; ++n) {
      for (int m = -400; m < 400; ++m) {
        const double x = 0.04 * n + 0.02, y = 0.04 * m + 0.02;
        points.emplace_back(x, y, slope_x * x + slope_y * y + (is_box(x, y) ? 0.5 : 0.0));
        const double away = std::max(std::abs(x), std::abs(y));
        if (is_box(x, y)) box.push_back(points.back());
        if (away > 1.5 && away < 6.0) road.push_back(points.back());
      }
    }
    const Terrain terrain = terrain_of(points);
    const std::vector<float> of_road = heights_of(terrain, road);
    // A tenth counts as level: within a column it is 2.8 cm to either side at most.
    CHECK(*std::max_element(of_road.begin(), of_road.end()) < Parameters{}.ground_height);
    CHECK(*std::min_element(of_road.begin(), of_road.end()) > -0.05F);
    // The ground below the box rises by 0.2 a metre from its edge.
    const std::vector<float> of_box = heights_of(terrain, box);
    CHECK(*std::min_element(of_box.begin(), of_box.end()) > 0.5F - 0.3F);
  }
}

TEST_CASE("ground found scan by scan is the ground found at once") {
  // Each scan covers all of it, or a strip that overlaps with the next scan's.
  const double width = GENERATE(120.0, 24.0);
  const double step = (120.0 - width) / 4.0;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-60.0, 60.0), rough(0.0, 0.3);
  Terrain at_once{Parameters{}}, in_parts{Parameters{}};
  std::vector<Eigen::Vector3d> all;
  for (int scan = 0; scan < 5; ++scan) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 40000; ++i) {
      const double x = -60.0 + scan * step + width / 120.0 * (place(random) + 60.0);
      const double y = place(random);
      points.emplace_back(x, y, (x < 0.0 ? 0.1 : 0.4) * x + rough(random));
    }
    in_parts.add(cells_of(in_parts, points), RunContext{});
    in_parts.update(RunContext{.threads = 2});
    all.insert(all.end(), points.begin(), points.end());
  }
  at_once.add(cells_of(at_once, all), RunContext{});
  at_once.update(RunContext{});
  std::vector<Eigen::Vector3d> asked;
  for (int i = 0; i < 2000; ++i) asked.emplace_back(place(random), place(random), 0.0);
  REQUIRE(heights_of(at_once, asked) == heights_of(in_parts, asked, 2));
}

}  // namespace raymoval::raymoval_plus_test
