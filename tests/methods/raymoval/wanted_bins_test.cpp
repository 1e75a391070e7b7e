// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/angle.h"
#include "core/simd/instruction_set_scope.h"
#include "tests/methods/raymoval/random_map.h"
#include "tests/methods/raymoval/window_values.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using random_map::Random;

namespace {

/// Finite values with this probability.
std::vector<float> random_values(const AngularGrid& grid, double share, Random& random) {
  std::vector<float> values(static_cast<std::size_t>(grid.size()), kNoRange);
  for (float& value : values) {
    if (random.real(0, 1) < share) value = static_cast<float>(random.real(0, 50));
  }
  return values;
}

}  // namespace

TEST_CASE("bins are wanted around every value, and nowhere else") {
  Random random(23);
  for (int round = 0; round < 60; ++round) {
    // Whole and broken words, one column, one row, and a row after the last at a word's border.
    const AngularGrid grid{round % 3 == 0 ? 64 * random.integer(1, 3) : random.integer(1, 150),
                           round % 4 == 0 ? 64 * random.integer(1, 2) : random.integer(1, 140),
                           -0.5, 0.5};
    const std::vector<float> values = random_values(grid, random.real(0, 0.1), random);
    const int radius = random.integer(0, 4);
    INFO(grid.azimuth_bins << " x " << grid.elevation_bins << ", radius " << radius);
    WantedBins wanted;
    wanted.request_all(grid);  // Replaces earlier requests.
    wanted.request_around(values, grid, radius);
    for (int bin = 0; bin < grid.size(); ++bin) {
      const auto around = values_around(values, {grid, radius, radius}, bin);
      REQUIRE(wanted.contains(grid, bin) ==
              std::any_of(around.begin(), around.end(), [](float v) { return v != kNoRange; }));
    }
    for (int i = 0; i < grid.azimuth_bins; ++i) {
      const auto after = static_cast<std::size_t>(grid.elevation_bins);
      REQUIRE(wanted.column(i)[after / 64] >> after % 64 == 0);
    }
  }
}

TEST_CASE("first hits that are asked for do not depend on which others are", "[simd]") {
  Random random(29);
  for (int round = 0; round < 20; ++round) {
    OccupancyMap map(0.2);
    random_map::fill(map, {0, 0, 0}, 30, random);
    const Pose pose = random_map::pose({random.real(-2, 2), random.real(-2, 2), 0.3}, random, 0.3);
    const AngularGrid grid{random.integer(1, 130), random.integer(1, 120), -40 * kDegree,
                           random.real(-30, 40) * kDegree};
    const RayLimits limits{random.real(0, 1.5), random.real(4, 12)};
    const FirstHitImage all = cast_first_hits(map, pose, grid, limits, 1);
    const std::vector<float> values = random_values(grid, random.real(0, 0.2), random);
    WantedBins wanted;
    wanted.request_around(values, grid, 1);
    for (const InstructionSet set : supported_instruction_sets()) {
      INFO(instruction_set_name(set));
      const InstructionSetScope scope(set);
      FirstHitCaster caster(grid, limits);
      FirstHitImage some;
      for (const int threads : {1, 3}) {
        caster.cast(map, pose, wanted, threads, some);
        for (int bin = 0; bin < grid.size(); ++bin) {
          if (!wanted.contains(grid, bin)) continue;
          const auto at = static_cast<std::size_t>(bin);
          REQUIRE(some.range[at] == all.range[at]);
        }
      }
    }
  }
}

}  // namespace raymoval::raymoval_test
