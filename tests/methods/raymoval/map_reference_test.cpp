// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/simd/instruction_set_scope.h"
#include "tests/methods/raymoval/window_values.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

namespace {
constexpr float kInf = kNoRange;
}

TEST_CASE("eq. 9: the percentile is one of the values") {
  const std::vector<float> sorted = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  // Rank round(q * 8): 0.9 -> 7, 0.1 -> 1, 0.5 -> 4.
  CHECK(percentile_of_sorted(sorted.data(), 9, 0.9) == 8);
  CHECK(percentile_of_sorted(sorted.data(), 9, 0.1) == 2);
  CHECK(percentile_of_sorted(sorted.data(), 9, 0.5) == 5);
  CHECK(percentile_of_sorted(sorted.data(), 9, 0.0) == 1);
  CHECK(percentile_of_sorted(sorted.data(), 9, 1.0) == 9);
  CHECK(percentile_of_sorted(sorted.data(), 1, 0.9) == 1);
}

TEST_CASE("eq. 8: windows wrap around in azimuth and stop at the rows' end") {
  // 5 columns, 3 rows; infinite = the ray hits nothing.
  const AngularGrid grid{5, 3, 0.0, 0.3};
  const std::vector<float> hits = {1,    2, 3,    4, 5,  //
                                   kInf, 6, kInf, 7, 8,  //
                                   kInf, 9, kInf, 3, kInf};
  const auto lowest = windowed_percentile(hits, grid, 1, 0.0, 1);
  const auto highest = windowed_percentile(hits, grid, 1, 1.0, 1);
  // Around (row 0, column 0): columns 4, 0, 1 of rows 0 and 1: 5 1 2, 8 inf 6.
  CHECK(lowest[0] == 1);
  CHECK(highest[0] == 8);
  // Around (row 2, column 2): columns 1-3 of rows 1 and 2: 6 inf 7, 9 inf 3.
  CHECK(lowest[12] == 3);
  CHECK(highest[12] == 9);
  // Radius 0 is the bin itself, infinite included.
  CHECK(windowed_percentile(hits, grid, 0, 0.9, 1) == hits);
  // All columns within two of column 2, the one in the middle.
  CHECK(windowed_percentile(hits, grid, 1, 0.5, 4) == windowed_percentile(hits, grid, 1, 0.5, 1));
}

TEST_CASE("the windowed minimum has its own reach along rows and columns") {
  const AngularGrid grid{4, 3, 0.0, 0.3};
  const std::vector<float> ranges = {kInf, kInf, kInf, kInf,  //
                                     kInf, 5,    kInf, kInf,  //
                                     kInf, kInf, kInf, 7};
  const auto minimum = [&](int azimuth_radius, int elevation_radius) {
    std::vector<float> result;
    for (int bin = 0; bin < grid.size(); ++bin) {
      result.push_back(windowed_minimum(ranges, {grid, azimuth_radius, elevation_radius}, bin));
    }
    return result;
  };
  CHECK(minimum(1, 0) == std::vector<float>{kInf, kInf, kInf, kInf, 5, 5, 5, kInf, 7, kInf, 7, 7});
  CHECK(minimum(0, 1) ==
        std::vector<float>{kInf, 5, kInf, kInf, kInf, 5, kInf, 7, kInf, 5, kInf, 7});
}

namespace {

/// One bin of `empty` is empty; 0: none.
std::vector<float> random_image(const AngularGrid& grid, unsigned seed, unsigned empty = 3) {
  std::mt19937 random(seed);
  std::vector<float> values;
  for (int bin = 0; bin < grid.size(); ++bin) {
    values.push_back(empty != 0 && random() % empty == 0 ? kInf
                                                         : static_cast<float>(random() % 50));
  }
  return values;
}

}  // namespace

TEST_CASE("window percentiles equal those of each window, on every instruction set", "[simd]") {
  for (const int columns : {3, 5, 7, 15, 16, 17, 23, 64, 101}) {
    for (const int rows : {1, 2, 3, 20}) {
      const AngularGrid grid{columns, rows, 0.0, 0.3};
      const unsigned empty = rows == 20 ? 0 : rows == 3 ? 100 : 3;
      const std::vector<float> values = random_image(grid, 1, empty);
      const std::vector<float> wanted = random_image(grid, 2);
      for (const InstructionSet set : supported_instruction_sets()) {
        const InstructionSetScope scope(set);
        INFO(instruction_set_name(set) << ", " << columns << " x " << rows);
        WindowPercentiles found;
        windowed_percentiles(values, wanted, grid, 1, {0.9, 0.1}, 2, found);
        for (int bin = 0; bin < grid.size(); ++bin) {
          const auto at = static_cast<std::size_t>(bin);
          if (wanted[at] == kInf) continue;
          std::vector<float> window = values_around(values, {grid, 1, 1}, bin);
          std::erase(window, kInf);
          std::sort(window.begin(), window.end());
          const int count = static_cast<int>(window.size());
          const auto expected = [&](double q) {
            return count == 0 ? kInf : percentile_of_sorted(window.data(), count, q);
          };
          REQUIRE(found.first[at] == expected(0.9));
          REQUIRE(found.second[at] == expected(0.1));
        }
      }
    }
  }
}

}  // namespace raymoval::raymoval_test
