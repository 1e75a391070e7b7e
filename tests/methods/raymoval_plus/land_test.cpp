// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/land.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

constexpr int kLandSide = 61, kMiddle = 30;
constexpr double kColumn = 0.4;
constexpr std::size_t kAtMiddle = std::size_t{kMiddle} * kLandSide + kMiddle;

/// A square of columns. @param height of the column (x, y), metres
template <class Height>
std::vector<float> ground_of(Height&& height) {
  std::vector<float> ground;
  for (int y = 0; y < kLandSide; ++y) {
    for (int x = 0; x < kLandSide; ++x) ground.push_back(height(x, y));
  }
  return ground;
}

}  // namespace

TEST_CASE("land rises as a plane does, whatever stands on it") {
  const auto plane = [](int x, int y) {
    return 0.2F * static_cast<float>(x) - 0.1F * static_cast<float>(y);
  };
  const std::vector<float> bare = ground_of(plane);
  CHECK(land_rise(bare, kLandSide, 0)[kAtMiddle] == Approx(0.2).margin(1e-4));
  CHECK(land_rise(bare, kLandSide, 1)[kAtMiddle] == Approx(-0.1).margin(1e-4));
  // The edges of a low object cancel out, and the edges of a house do not count.
  for (const float high : {0.15F, 3.0F}) {
    const std::vector<float> with_box = ground_of([&](int x, int y) {
      const bool is_box = x >= 25 && x < 31 && y >= 27 && y < 38;
      return plane(x, y) + (is_box ? high : 0.0F);
    });
    CHECK(land_rise(with_box, kLandSide, 0)[kAtMiddle] == Approx(0.2).margin(1e-4));
    CHECK(land_rise(with_box, kLandSide, 1)[kAtMiddle] == Approx(-0.1).margin(1e-4));
  }
}

TEST_CASE("land of which little is known is level") {
  // Five columns in a row: one of them has ground two columns to either side. Of its 25
  // differences, 24 count as 0.
  const std::vector<float> ground = ground_of([](int x, int y) {
    const bool is_known = y == kMiddle && x >= kMiddle - 2 && x <= kMiddle + 2;
    return is_known ? 0.2F * static_cast<float>(x) : std::numeric_limits<float>::infinity();
  });
  CHECK(land_rise(ground, kLandSide, 0)[kAtMiddle] == Approx(0.2 / 25.0).margin(1e-4));
  CHECK(land_rise(ground, kLandSide, 1)[kAtMiddle] == 0.0F);
}

TEST_CASE("a tenth counts as level, and what is above that as steep") {
  // A tenth of 0.4 m is 0.04 m a column.
  const GroundPlane level = steep_part(0.024F, -0.032F, kColumn);  // Together by just that.
  CHECK(level.rise_x == 0.0F);
  CHECK(level.rise_y == 0.0F);
  const GroundPlane steep = steep_part(0.12F, -0.16F, kColumn);  // 0.2 m: 0.16 m are above.
  CHECK(steep.rise_x == Approx(0.096));
  CHECK(steep.rise_y == Approx(-0.128));
  CHECK(steep.middle == 0.0F);
}

TEST_CASE("the low quantile of a plane is as far below its middle as that of many points on it") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> in_column(-0.5F, 0.5F);
  for (const auto& [rise_x, rise_y] :
       {std::pair(0.0F, 0.0F), std::pair(0.2F, 0.0F), std::pair(0.0F, -0.2F),
        std::pair(0.2F, 0.01F), std::pair(-0.1F, 0.2F), std::pair(0.15F, 0.15F)}) {
    const GroundPlane plane{0.0F, rise_x, rise_y};
    std::vector<float> heights;
    for (int n = 0; n < 100000; ++n) {
      heights.push_back(rise_x * in_column(random) + rise_y * in_column(random));
    }
    std::sort(heights.begin(), heights.end());
    for (const double quantile : {0.01, 0.05, 0.3}) {
      const float found = heights[static_cast<std::size_t>(quantile * 100000.0)];
      CHECK(quantile_below_middle(plane, quantile) == Approx(-found).margin(0.002));
    }
  }
}

}  // namespace raymoval::raymoval_plus_test
