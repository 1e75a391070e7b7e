// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/terrain/pits.h"

#include <catch2/catch.hpp>
#include <limits>
#include <random>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// The definition, column by column.
std::vector<float> slow_without_pits(const std::vector<float>& ground, int side, float drop) {
  std::vector<float> kept(ground.size(), kNone);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float value = ground[static_cast<std::size_t>(y * side + x)];
      int around = 0, not_above = 0;
      for (int v = std::max(y - kPitNeighbours, 0); v <= std::min(y + kPitNeighbours, side - 1);
           ++v) {
        for (int u = std::max(x - kPitNeighbours, 0); u <= std::min(x + kPitNeighbours, side - 1);
             ++u) {
          const float other = ground[static_cast<std::size_t>(v * side + u)];
          around += other < kNone ? 1 : 0;
          not_above += other < kNone && other <= value + drop ? 1 : 0;
        }
      }
      if (value < kNone && around >= kLeastPitNeighbours && not_above > around / 4) {
        kept[static_cast<std::size_t>(y * side + x)] = value;
      }
    }
  }
  return kept;
}

}  // namespace

TEST_CASE("pits are found as by counting, on even, rough and sparse ground") {
  std::mt19937 random(5);
  const int side = GENERATE(1, 15, 16, 33, 86);
  const double rough = GENERATE(0.0, 0.3, 2.0), holes = GENERATE(0.0, 0.5, 0.97);
  std::uniform_real_distribution<double> height(-rough, rough), any(0.0, 1.0);
  std::vector<float> ground(static_cast<std::size_t>(side * side));
  for (float& z : ground) {
    z = static_cast<float>(height(random) - (any(random) < 0.1 ? 1.0 : 0.0));
    if (any(random) < holes) z = kNone;
  }
  CHECK(without_pits(ground, side, 0.5F) == slow_without_pits(ground, side, 0.5F));
}

}  // namespace raymoval::raymoval_plus_test
