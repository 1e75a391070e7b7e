// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/terrain.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <map>

#include "core/angle.h"
#include "core/error.h"
#include "tests/methods/mapcleaner/scenes.h"

namespace raymoval::mapcleaner_test {
using namespace raymoval::mapcleaner_method;

namespace {

using Cells = std::map<std::pair<int, int>, double>;

HeightGrid grid_of(const Cells& cells) {
  HeightGrid grid(kNoHeight);
  HeightGrid::Cursor cursor;
  for (const auto& [at, height] : cells) grid.make({at.first, at.second, 0}, cursor) = height;
  return grid;
}

double height_of(const HeightGrid& grid, int x, int y) {
  HeightGrid::Cursor cursor;
  return grid.get({x, y, 0}, cursor);
}

bool has_height(const HeightGrid& grid, int x, int y) {
  return !std::isnan(height_of(grid, x, y));
}

/// Cells from (0, 0) to (9, 4) whose heights are given by x.
template <class Height>
HeightGrid strip(Height&& height) {
  Cells cells;
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 5; ++y) cells[{x, y}] = height(x);
  }
  return grid_of(cells);
}

}  // namespace

TEST_CASE("mapcleaner: cells without a height take the mean of those around, by their distance") {
  // Half the radius of two cells away the kernel is (2 - 1) / 3 * 0.5 = 1/6. Cell (0, 0) has three
  // neighbours there, and the fourth lies at the radius itself and does not count.
  const HeightGrid grid = grid_of({{{1, 0}, 1.0}, {{-1, 0}, 2.0}, {{0, 1}, 6.0}, {{0, -2}, 50.0}});
  const HeightGrid found = filled(grid, {2.0, 1e6, 1}, 1);
  CHECK(height_of(found, 0, 0) == Approx(3.0).epsilon(1e-5));
  CHECK(height_of(found, 1, 0) == 1.0);  // Cells with a height keep it.
  CHECK_FALSE(has_height(filled(grid, {0.0, 1e6, 1}, 1), 0, 0));
  // Of three cells each, (0, 0) and (0, 1) have enough around them. The other two neighbours have
  // no smooth height, and do not count.
  const HeightGrid sparse = filled(grid, {2.0, 1e6, 3}, 1);
  CHECK(height_of(sparse, 0, 0) == Approx(6.0).epsilon(1e-5));
  CHECK_FALSE(has_height(sparse, 0, -1));
  CHECK_FALSE(has_height(filled(grid, {2.0, 1e6, 4}, 1), 0, 0));
  // At distance sqrt(2), d = 0.7071: the kernel is (2 + cos 254.6) / 3 * 0.2929 + sin 254.6 / 2 pi
  // = 0.1693 - 0.1534 = 0.0159. The mean by these weights of 1 twice and of 4:
  const HeightGrid corner = grid_of({{{1, 0}, 1.0}, {{-1, 0}, 1.0}, {{1, 1}, 4.0}});
  CHECK(height_of(filled(corner, {2.0, 1e6, 1}, 1), 0, 0) ==
        Approx((2.0 / 6.0 + 4.0 * 0.0159) / (2.0 / 6.0 + 0.0159)).epsilon(1e-3));
}

TEST_CASE("mapcleaner: a cell that deviates from the smooth ground counts less when filling") {
  // A plate of heights 0 with a hole, and a spike of 1 m beside it. The spike's own smooth height
  // is far below it, so that with a small deviation the hole is filled by the others alone.
  Cells cells;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) cells[{x, y}] = 0.0;
  }
  cells[{1, 0}] = 1.0;
  cells.erase({0, 0});
  const HeightGrid grid = grid_of(cells);
  const double plain = height_of(filled(grid, {3.0, 1e6, 3}, 1), 0, 0);
  const double robust = height_of(filled(grid, {3.0, 0.1, 3}, 1), 0, 0);
  CHECK(plain > 0.05);
  CHECK(robust < 1e-3);
  CHECK(robust >= 0.0);
}

TEST_CASE("mapcleaner: where all cells are far from smooth, they count alike") {
  // Heights of 0 and 1 m in turn: each is half a metre from its smooth height, 500 deviations.
  Cells cells;
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) cells[{x, y}] = (x + y) % 2 == 0 ? 0.0 : 1.0;
  }
  cells.erase({0, 0});
  const HeightGrid grid = grid_of(cells);
  const double plain = height_of(filled(grid, {3.0, 1e6, 3}, 1), 0, 0);
  const double rough = height_of(filled(grid, {3.0, 0.001, 3}, 1), 0, 0);
  CHECK(plain > 0.1);
  CHECK(rough == Approx(plain).epsilon(1e-3));
}

TEST_CASE("mapcleaner: filling goes over the borders of tiles and not by threads") {
  Cells cells;
  for (int x = -70; x < 140; x += 2) {
    for (int y = -3; y < 70; y += 3) cells[{x, y}] = 0.01 * x - 0.02 * y;
  }
  const HeightGrid grid = grid_of(cells);
  const HeightGrid one = filled(grid, {5.0, 1.0, 3}, 1), two = filled(grid, {5.0, 1.0, 3}, 3);
  int filled_cells = 0;
  for (int x = -76; x < 146; ++x) {
    for (int y = -9; y < 76; ++y) {
      const double height = height_of(one, x, y);
      CHECK((height == height_of(two, x, y) || (std::isnan(height) && !has_height(two, x, y))));
      // Inside the slope: neighbours balance, except for their places on the lattice.
      if (x < -64 || x > 132 || y < 2 || y > 62) continue;
      ++filled_cells;
      if (std::abs(height - (0.01 * x - 0.02 * y)) > 0.03) FAIL(x << " " << y << " " << height);
    }
  }
  CHECK(filled_cells == 197 * 61);
}

TEST_CASE("mapcleaner: terrain goes on over slopes below the limit from below the sensor") {
  const double limit = 15.0 * kDegree;
  const auto sloped = [](double degrees) {
    return [=](int x) { return 0.2 * (x - 3) * std::tan(degrees * kDegree) * (x > 3 ? 1 : 0); };
  };
  const HeightGrid gentle = reachable(strip(sloped(10)), {{0, 0, 0}}, 0.2, limit, 0.0);
  CHECK(has_height(gentle, 9, 4));
  CHECK(height_of(gentle, 9, 4) == Approx(0.2 * 6 * std::tan(10 * kDegree)));
  const HeightGrid steep = reachable(strip(sloped(20)), {{0, 0, 0}}, 0.2, limit, 0.0);
  CHECK(has_height(steep, 3, 4));  // Over both neighbours it rises half as steeply.
  CHECK_FALSE(has_height(steep, 4, 4));
  CHECK_FALSE(has_height(steep, 9, 4));
  // A step of 0.2 m between cells of 0.2 m: 26.6 degrees over both neighbours on either side.
  const HeightGrid step =
      reachable(strip([](int x) { return x < 5 ? 0.0 : 0.2; }), {{0, 2, 0}}, 0.2, limit, 0.0);
  CHECK(has_height(step, 3, 2));
  CHECK_FALSE(has_height(step, 4, 2));
  CHECK_FALSE(has_height(step, 8, 2));
}

TEST_CASE("mapcleaner: from a place that is too steep the way begins beside it") {
  // Up to x = 3 it rises by 20 degrees, from there on it is level.
  const double limit = 15.0 * kDegree;
  const HeightGrid grid =
      strip([](int x) { return 0.2 * (x < 4 ? x : 4) * std::tan(20 * kDegree); });
  CHECK(reachable(grid, {{1, 2, 0}}, 0.2, limit, 0.0).block_count() == 0);
  const HeightGrid found = reachable(grid, {{1, 2, 0}}, 0.2, limit, 8.5);
  CHECK(has_height(found, 4, 0));
  CHECK(has_height(found, 9, 4));
  CHECK_FALSE(has_height(found, 3, 2));
  CHECK_FALSE(has_height(found, 1, 2));
}

TEST_CASE("mapcleaner: on a hill slopes count from its own") {
  // 30 percent are 16.7 degrees. From x = 7 on the hill is 65 percent steep, which
  // is 19 degrees from the plane of the rest by its gradient.
  const double limit = 15.0 * kDegree;
  const auto hill = [](int x) { return 0.2 * (0.3 * x + (x > 7 ? 0.35 * (x - 7) : 0.0)); };
  const HeightGrid grid = strip(hill);
  CHECK(reachable(grid, {{2, 2, 0}}, 0.2, limit, 0.0).block_count() == 0);
  const HeightGrid found = reachable(grid, {{2, 2, 0}}, 0.2, limit, 4.0);
  for (int x = 0; x <= 7; ++x) CHECK(height_of(found, x, 2) == hill(x));
  CHECK_FALSE(has_height(found, 8, 2));
  CHECK_FALSE(has_height(found, 9, 2));
}

TEST_CASE("mapcleaner: a run that is cancelled finds no terrain") {
  Terrain terrain{Parameters{}};
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  CHECK_THROWS_AS(terrain.finish(context), Cancelled);
}

TEST_CASE("mapcleaner: terrain is found over corners, but not over gaps") {
  const HeightGrid grid =
      grid_of({{{0, 0}, 0.0}, {{1, 1}, 0.0}, {{2, 2}, 0.0}, {{4, 2}, 0.0}, {{5, 2}, 0.0}});
  const HeightGrid found = reachable(grid, {{0, 0, 0}}, 0.2, 0.2, 0.0);
  CHECK(has_height(found, 2, 2));
  CHECK_FALSE(has_height(found, 4, 2));
  // From a place without a height there is a way only within the radius, from the nearest cells.
  CHECK_FALSE(has_height(reachable(grid, {{7, 2, 0}}, 0.2, 0.2, 1.9), 5, 2));
  const HeightGrid near = reachable(grid, {{7, 2, 0}}, 0.2, 0.2, 2.0);
  CHECK(has_height(near, 4, 2));
  CHECK_FALSE(has_height(near, 2, 2));
  const HeightGrid both = reachable(grid, {{3, 2, 0}}, 0.2, 0.2, 9.0);
  CHECK(has_height(both, 0, 0));
  CHECK(has_height(both, 5, 2));
}

TEST_CASE("mapcleaner: the median is the upper one of those that are there") {
  const HeightGrid grid = grid_of({{{0, 0}, 5.0}, {{1, 0}, 1.0}, {{0, 1}, 2.0}, {{1, 1}, 3.0}});
  const HeightGrid found = smoothed(grid, 1);
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 1)})
    CHECK(height_of(found, x, y) == 3.0);
  CHECK_FALSE(has_height(found, 2, 0));
}

TEST_CASE("mapcleaner: a cell has a height by its ground points' number and variance") {
  Parameters parameters;
  parameters.fill_radius = parameters.refill_radius = 0.0;
  parameters.terrain_points = 3;
  const auto terrain_of = [&](const WorldPoints& points) {
    toy::HeldScans scans;
    scans.add_world(Eigen::Vector3d(0.1, 0.1, 1.7), points);
    Terrain terrain(parameters);
    terrain.add(scans.load(0), Mask(points.size(), 1));
    terrain.finish({});
    return height_of(terrain.heights(), 0, 0);
  };
  const WorldPoints three = {{0.1, 0.1, 0.0}, {0.1, 0.15, 0.1}, {0.05, 0.1, 0.2}};
  CHECK(terrain_of(three) == Approx(0.1).margin(1e-6));  // Variance 0.00667.
  CHECK(std::isnan(terrain_of({three[0], three[1]})));
  WorldPoints rough = three;
  rough[2].z() = 0.3;  // 0.0156.
  CHECK(std::isnan(terrain_of(rough)));
}

}  // namespace raymoval::mapcleaner_test
