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

}  // namespace

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

TEST_CASE("mapcleaner: a run that is cancelled finds no terrain") {
  Terrain terrain{Parameters{}};
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  CHECK_THROWS_AS(terrain.finish(context), Cancelled);
}

}  // namespace raymoval::mapcleaner_test
