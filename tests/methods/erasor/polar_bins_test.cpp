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
