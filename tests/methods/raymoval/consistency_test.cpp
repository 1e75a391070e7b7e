// SPDX-License-Identifier: MIT
#include "methods/raymoval/consistency.h"

#include <catch2/catch.hpp>

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

TEST_CASE("eq. 11: a point is dynamic if the map lies farther by more than the margin") {
  // The map is a wall at 10 m. Margin 0.3 + 0.35 r: a point at 7 m would need 2.75 m of distance
  // and has 3; at 8 m it would need 3.1 and has 2.
  ProjectedScan scan;
  scan.range = {7.0F, 8.0F, 12.0F, 5.0F, 5.0F};
  scan.bin = {0, 0, 0, 1, -1};
  const Mask dynamic = check_consistency(scan, {10.0F, kNoRange}, {0.3, 0.35});
  // Behind the map, without a map reference, in no bin: not dynamic.
  CHECK(dynamic == Mask{1, 0, 0, 0, 0});
}

TEST_CASE("flat ground seen at a grazing angle is not seen through") {
  // A ray that falls 0.05 m per metre crosses 0.2 m of height in 4 m, in any direction.
  CHECK(grazing_distance(-0.05, 0.2, 5.0) == Approx(4.0));
  CHECK(grazing_distance(0.05, 0.2, 5.0) == Approx(4.0));
  // Level rays would never cross it: the limit is used.
  CHECK(grazing_distance(-0.001, 0.2, 5.0) == Approx(5.0));
  CHECK(grazing_distance(0.0, 0.2, 5.0) == Approx(5.0));
  CHECK(grazing_distance(-1.0, 0.2, 5.0) == Approx(0.2));
}

}  // namespace raymoval::raymoval_test
