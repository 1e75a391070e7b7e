// SPDX-License-Identifier: MIT
#include "methods/raymoval/map_reference.h"

#include <catch2/catch.hpp>

using namespace raymoval;

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

TEST_CASE("a window without any hit has no reference") {
  const AngularGrid grid{4, 1, 0.0, 0.1};
  const std::vector<float> hits = {kInf, kInf, kInf, 3};
  CHECK(windowed_percentile(hits, grid, 1, 0.9, 1) == std::vector<float>{3, kInf, 3, 3});
}

TEST_CASE("the windowed minimum has its own reach along rows and columns") {
  const AngularGrid grid{4, 3, 0.0, 0.3};
  const std::vector<float> ranges = {kInf, kInf, kInf, kInf,  //
                                     kInf, 5,    kInf, kInf,  //
                                     kInf, kInf, kInf, 7};
  CHECK(windowed_minimum(ranges, grid, 1, 0, 1) ==
        std::vector<float>{kInf, kInf, kInf, kInf, 5, 5, 5, kInf, 7, kInf, 7, 7});
  CHECK(windowed_minimum(ranges, grid, 0, 1, 2) ==
        std::vector<float>{kInf, 5, kInf, kInf, kInf, 5, kInf, 7, kInf, 5, kInf, 7});
}
