// SPDX-License-Identifier: MIT
#include "methods/erasor/polar_bins.h"

#include <catch2/catch.hpp>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

/// Extent of the bin with the points on a radial grade of 15 % from 4.05 m to `end`.
BinExtent grade_extent(double end, double object_height) {
  BinExtent extent;
  for (double r = 4.05; r < end; r += 0.01) extent.add(0.15 * r);
  if (object_height > 0.0) extent.add(extent.highest + object_height);
  return extent;
}

/// A bin of `points` points from 0 to `height`.
BinExtent bin(double height, int points = 10) {
  BinExtent extent;
  for (int i = 0; i < points; ++i) extent.add(i == 0 ? 0.0 : height);
  return extent;
}

/// '-' if voxels go out, '+' if those of the query come in.
std::string done(const BinAction& action) {
  return std::string(action.remove ? "-" : "") + (action.reinsert ? "+" : "");
}

}  // namespace

TEST_CASE("a point falls into its ring and sector", "[erasor]") {
  const PolarBins bins(small_grid());
  REQUIRE(bins.size() == 40);
  CHECK(bins.bin_of({1, 0.5, 0}) == 0);     // r = 1.1, 27 degrees
  CHECK(bins.bin_of({3, 0.75, 0}) == 8);    // r = 3.1: ring 1
  CHECK(bins.bin_of({-0.5, 3, 0}) == 10);   // 99 degrees: sector 2
  CHECK(bins.bin_of({3, -0.75, 0}) == 15);  // 346 degrees: sector 7
  CHECK(bins.bin_of({9, 0.5, 0}) == 32);    // ring 4
}

TEST_CASE("the sectors' seam lies on the x axis", "[erasor]") {
  const PolarBins bins(small_grid());
  CHECK(bins.bin_of({5, 0.001, 0}) == 2 * 8 + 0);
  CHECK(bins.bin_of({5, -0.001, 0}) == 2 * 8 + 7);
  CHECK(bins.bin_of({5, -1e-300, 0}) == 2 * 8 + 7);  // 2 pi after rounding: still the last sector
  CHECK(bins.bin_of({-5, 0.0, 0}) == 2 * 8 + 4);
  CHECK(bins.bin_of({-5, -0.0, 0}) == 2 * 8 + 4);  // atan2 gives -pi
  CHECK(bins.bin_of({0, 0, 0}) == 0);
}

TEST_CASE("the height window is open, the range closed", "[erasor]") {
  const PolarBins bins(small_grid());
  CHECK(bins.bin_of({3, 0.75, -1}) == -1);
  CHECK(bins.bin_of({3, 0.75, 3}) == -1);
  CHECK(bins.bin_of({3, 0.75, -0.999}) == 8);
  CHECK(bins.bin_of({3, 0.75, 2.999}) == 8);
  CHECK(bins.bin_of({10, 0, 0}) == 4 * 8);
  CHECK(bins.bin_of({10.001, 0, 0}) == -1);
  CHECK(bins.bin_of({std::nan(""), 0, 0}) == -1);
  CHECK(bins.bin_of({0, 0, std::nan("")}) == -1);
}

TEST_CASE("a bin's pseudo occupancy is the height between its lowest and highest point",
          "[erasor]") {
  BinExtent extent;
  CHECK(extent.extent() == 0.0);
  extent.add(0.5);
  CHECK(extent.extent() == 0.0);
  extent.add(-0.25);
  extent.add(0.25);
  CHECK(extent.extent() == 0.75);
  CHECK(extent.points == 3);
}

TEST_CASE("the bins' size limits the slope on which an object is found", "[erasor]") {
  Parameters parameters;
  parameters.minimum_points = 3;
  // Rings of 2 m: road 0.29 m, with the car 1.79 m, ratio 0.16.
  CHECK(compare_extents(grade_extent(6, 1.5), grade_extent(6, 0), parameters) ==
        BinFinding::kMapHigher);
  // Rings of 4 m: 0.59 m and 2.09 m, ratio 0.28.
  CHECK(compare_extents(grade_extent(8, 1.5), grade_extent(8, 0), parameters) ==
        BinFinding::kEqual);
}

TEST_CASE("extents are compared by their ratio, strictly", "[erasor]") {
  const Parameters parameters = small_grid();
  CHECK(compare_extents(bin(1.5), bin(0.31), parameters) == BinFinding::kEqual);      // 0.207
  CHECK(compare_extents(bin(1.5), bin(0.29), parameters) == BinFinding::kMapHigher);  // 0.193
  CHECK(compare_extents(bin(0.29), bin(1.5), parameters) == BinFinding::kCurrentHigher);
  Parameters quarter = parameters;
  quarter.ratio_threshold = 0.25;
  CHECK(compare_extents(bin(2.0), bin(0.5), quarter) == BinFinding::kEqual);
  CHECK(compare_extents(bin(2.0), bin(0.49), quarter) == BinFinding::kMapHigher);
}

TEST_CASE("flat bins: zero over zero is equal, zero against something is not", "[erasor]") {
  const Parameters parameters = small_grid();
  CHECK(compare_extents(bin(0), bin(0), parameters) == BinFinding::kEqual);
  CHECK(compare_extents(bin(1), bin(0), parameters) == BinFinding::kMapHigher);
  CHECK(compare_extents(bin(0), bin(1), parameters) == BinFinding::kCurrentHigher);
}

TEST_CASE("a query with few points says nothing, a map without any is told apart", "[erasor]") {
  const Parameters parameters = small_grid();  // At least 3 query points.
  CHECK(compare_extents(bin(1.5), bin(0, 2), parameters) == BinFinding::kTooFewPoints);
  CHECK(compare_extents(bin(1.5), bin(0, 0), parameters) == BinFinding::kTooFewPoints);
  CHECK(compare_extents(bin(1.5), bin(0, 3), parameters) == BinFinding::kMapHigher);
  // There is no such demand on the map.
  CHECK(compare_extents(bin(1.5, 2), bin(0, 3), parameters) == BinFinding::kMapHigher);
  CHECK(compare_extents(bin(0, 0), bin(0, 3), parameters) == BinFinding::kQueryOnly);
  CHECK(compare_extents(bin(0, 0), bin(0, 2), parameters) == BinFinding::kTooFewPoints);
}

TEST_CASE("version 3 changes only bins where the map is higher and tall", "[erasor]") {
  const auto does = [](BinFinding finding, double height) {
    return done(action_for(finding, bin(height), small_grid()));
  };
  for (const BinFinding finding : {BinFinding::kTooFewPoints, BinFinding::kQueryOnly,
                                   BinFinding::kCurrentHigher, BinFinding::kEqual}) {
    CHECK(does(finding, 1.5) == "");
  }
  CHECK(does(BinFinding::kMapHigher, 0.51) == "-+");
  CHECK(does(BinFinding::kMapHigher, 0.5) == "");
}

TEST_CASE("version 2 asks for a high top instead and takes in what the query sees", "[erasor]") {
  Parameters parameters = small_grid();
  parameters.version = 2;
  parameters.minimum_top = 0.2;
  const auto does = [&](BinFinding finding, const BinExtent& map) {
    return done(action_for(finding, map, parameters));
  };
  CHECK(does(BinFinding::kMapHigher, bin(0.45)) == "-+");
  CHECK(does(BinFinding::kMapHigher, bin(0.2)) == "");
  CHECK(does(BinFinding::kEqual, bin(1)) == "+");
  CHECK(does(BinFinding::kQueryOnly, bin(0, 0)) == "+");
  CHECK(does(BinFinding::kCurrentHigher, bin(1)) == "");
  CHECK(does(BinFinding::kTooFewPoints, bin(1)) == "");
  // The top is a height above the road, not above the bin's own ground: 0.9 m of pit wall stays.
  BinExtent pit;
  pit.add(-0.8);
  pit.add(0.1);
  CHECK(does(BinFinding::kMapHigher, pit) == "");
}

}  // namespace raymoval::erasor_test
