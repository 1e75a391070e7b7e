// SPDX-License-Identifier: MIT
#include "methods/raymoval/consistency.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/simd/instruction_set_scope.h"

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

TEST_CASE("eq. 11 is strict: a difference equal to the margin is static") {
  ProjectedScan scan;
  scan.range = {8.0F};
  scan.bin = {0};
  CHECK(check_consistency(scan, {10.0F}, {2.0, 0.0}) == Mask{0});
  CHECK(check_consistency(scan, {10.0F}, {1.999, 0.0}) == Mask{1});
}

TEST_CASE("eq. 11 gives the same for every instruction set", "[simd]") {
  std::mt19937 random(8);
  const auto pick = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  ProjectedScan scan;
  std::vector<float> reference;
  for (int bin = 0; bin < 50; ++bin) {
    reference.push_back(bin % 7 == 0 ? kNoRange : 5.0F + 0.25F * static_cast<float>(pick(80)));
  }
  Mask expected;
  const RangeMargin margin{0.5, 0.25};  // Differences equal to the margin occur: all are exact.
  for (int k = 0; k < 203; ++k) {
    scan.range.push_back(0.25F * static_cast<float>(pick(100)));
    scan.bin.push_back(pick(52) - 2);
    const float map =
        scan.bin.back() < 0 ? kNoRange : reference[static_cast<std::size_t>(scan.bin.back())];
    const double ahead = map - scan.range.back();
    expected.push_back(map != kNoRange && ahead > 0.5 + 0.25 * scan.range.back() ? 1 : 0);
  }
  for (const InstructionSet set : supported_instruction_sets()) {
    const InstructionSetScope scope(set);
    CHECK(check_consistency(scan, reference, margin, 1) == expected);
  }
  CHECK(std::count(expected.begin(), expected.end(), 1) > 20);
}

TEST_CASE("a bin is seen through if its scan lies beyond the map by the margin at the map") {
  ProjectedScan scan;
  FirstHitImage hits;
  // Margin at a map range of 10 m: 0.3 + 0.1 * 10 = 1.3 m.
  // Six columns and two rows; there is nothing of the map in the second row.
  const BinWindow above_and_below{{6, 2, 0.0, 0.1}, 0, 1};
  scan.minimum_range = {11.2F,    11.4F,    kNoRange, 20.0F, 20.0F,    20.0F,  //
                        kNoRange, kNoRange, 20.0F,    10.1F, kNoRange, kNoRange};
  hits.range = {10, 10, 10, 10, kNoRange, 19.8F};
  hits.range.resize(12, kNoRange);
  const std::vector<float> reference = {10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10, 10};
  // Bin 2 has no return of its own, bin 3 a neighbour on the surface, bin 4 no first hit, and the
  // first hit of bin 5 is the surface that the scan sees.
  const auto found = find_seen_through(scan, above_and_below, hits, reference, {0.3, 0.1}, 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0].bin == 1);
  CHECK(found[0].nearest_return == 11.4F);
}

TEST_CASE("flat ground seen at a grazing angle is not seen through") {
  // A ray that falls 0.05 m a metre crosses 0.2 m of height in 4 m, whichever way it goes.
  CHECK(grazing_distance(-0.05, 0.2, 5.0) == Approx(4.0));
  CHECK(grazing_distance(0.05, 0.2, 5.0) == Approx(4.0));
  // Level rays would never cross it: the limit stands in.
  CHECK(grazing_distance(-0.001, 0.2, 5.0) == Approx(5.0));
  CHECK(grazing_distance(0.0, 0.2, 5.0) == Approx(5.0));
  CHECK(grazing_distance(-1.0, 0.2, 5.0) == Approx(0.2));
}

}  // namespace raymoval::raymoval_test
