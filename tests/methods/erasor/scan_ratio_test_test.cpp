// SPDX-License-Identifier: MIT
#include "methods/erasor/scan_ratio_test.h"

#include <catch2/catch.hpp>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

/// A bin of `points` points from 0 to `height`.
BinExtent bin(double height, int points = 10) {
  BinExtent extent;
  for (int i = 0; i < points; ++i) extent.add(i == 0 ? 0.0 : height);
  return extent;
}

}  // namespace

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
  Parameters parameters = small_grid();
  for (const BinFinding finding : {BinFinding::kTooFewPoints, BinFinding::kQueryOnly,
                                   BinFinding::kCurrentHigher, BinFinding::kEqual}) {
    const BinAction action = action_for(finding, bin(1.5), parameters);
    CHECK_FALSE(action.remove);
    CHECK_FALSE(action.reinsert);
  }
  const BinAction tall = action_for(BinFinding::kMapHigher, bin(0.51), parameters);
  CHECK(tall.remove);
  CHECK(tall.reinsert);
  const BinAction low = action_for(BinFinding::kMapHigher, bin(0.5), parameters);
  CHECK_FALSE(low.remove);
  CHECK_FALSE(low.reinsert);
  parameters.reinsert = false;
  CHECK(action_for(BinFinding::kMapHigher, bin(0.51), parameters).remove);
  CHECK_FALSE(action_for(BinFinding::kMapHigher, bin(0.51), parameters).reinsert);
}

TEST_CASE("version 2 asks for a high top instead and takes in what the query sees", "[erasor]") {
  Parameters parameters = small_grid();
  parameters.version = 2;
  parameters.minimum_top = 0.2;
  CHECK(action_for(BinFinding::kMapHigher, bin(0.45), parameters).remove);
  CHECK(action_for(BinFinding::kMapHigher, bin(0.45), parameters).reinsert);
  CHECK_FALSE(action_for(BinFinding::kMapHigher, bin(0.2), parameters).remove);
  CHECK_FALSE(action_for(BinFinding::kMapHigher, bin(0.2), parameters).reinsert);
  CHECK(action_for(BinFinding::kEqual, bin(1), parameters).reinsert);
  CHECK(action_for(BinFinding::kQueryOnly, bin(0, 0), parameters).reinsert);
  CHECK_FALSE(action_for(BinFinding::kEqual, bin(1), parameters).remove);
  CHECK_FALSE(action_for(BinFinding::kCurrentHigher, bin(1), parameters).reinsert);
  CHECK_FALSE(action_for(BinFinding::kTooFewPoints, bin(1), parameters).reinsert);
  // The top is a height above the road, not above the bin's own ground: 0.9 m of pit wall stays.
  BinExtent pit;
  pit.add(-0.8);
  pit.add(0.1);
  CHECK_FALSE(action_for(BinFinding::kMapHigher, pit, parameters).remove);
}

}  // namespace raymoval::erasor_test
