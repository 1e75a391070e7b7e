// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/far_ground.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "methods/raymoval_plus/terrain/land.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr double kCell = 0.4;

std::size_t at(int x, int y, int side) {
  return static_cast<std::size_t>(y * side + x);
}

/// Values of a square with `kFarReach` columns more on each side, which bound nothing.
std::vector<float> padded(const std::vector<float>& values, int side) {
  const int wide = side + 2 * kFarReach;
  std::vector<float> all(static_cast<std::size_t>(wide * wide), kNowhere);
  for (int y = 0; y < side; ++y) {
    std::copy_n(values.data() + y * side, side, all.data() + (y + kFarReach) * wide + kFarReach);
  }
  return all;
}

/// The ground of a square without ground around it, bounded.
std::vector<float> bounded(const std::vector<float>& ground, int side) {
  const std::vector<float> rises =
      highest_rises(land_rise(ground, side, 0), land_rise(ground, side, 1), kCell, 0.1);
  return bounded_from_afar(padded(ground, side), padded(rises, side), side + 2 * kFarReach);
}

}  // namespace

TEST_CASE("what stands beyond a gap is bounded by the ground before it") {
  // The ground is known up to column 10. An object of a metre height is found from column 20 on.
  const int side = 61;
  std::vector<float> ground(std::size_t{61} * 61, kNowhere);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x <= 10; ++x) ground[at(x, y, side)] = 0.0F;
    for (int x = 20; x <= 35; ++x) ground[at(x, y, side)] = 1.0F;
  }
  const std::vector<float> found = bounded(ground, side);
  // The land is level: no two columns of it have other heights. 0.04 m for each column then.
  CHECK(found[at(0, 30, side)] == 0.0F);
  CHECK(found[at(10, 30, side)] == 0.0F);
  CHECK(found[at(15, 30, side)] == kNowhere);
  CHECK(found[at(20, 30, side)] == Approx(0.40));
  CHECK(found[at(24, 30, side)] == Approx(0.56));
  CHECK(found[at(32, 30, side)] == Approx(0.88));
  // 22 columns are as far as it reaches.
  CHECK(found[at(33, 30, side)] == 1.0F);
}

TEST_CASE("a slope of any steepness bounds nothing that lies on it") {
  const int side = 80;
  for (const float slope_x : {0.0F, 0.15F, -0.4F}) {
    for (const float slope_y : {0.0F, 0.3F}) {
      std::vector<float> ground(std::size_t{80} * 80);
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          ground[at(x, y, side)] =
              0.4F * (slope_x * static_cast<float>(x) + slope_y * static_cast<float>(y));
        }
      }
      CHECK(bounded(ground, side) == ground);
      // A box on it is cut, however the land rises.
      std::vector<float> with_box = ground;
      for (int y = 38; y < 42; ++y) {
        for (int x = 38; x < 42; ++x) with_box[at(x, y, side)] += 1.5F;
      }
      const std::vector<float> found = bounded(with_box, side);
      CHECK(found[at(40, 40, side)] - ground[at(40, 40, side)] < 0.7F);
    }
  }
}

}  // namespace raymoval::raymoval_plus_test
