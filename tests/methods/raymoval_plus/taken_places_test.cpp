// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/taken_places.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

ObjectSummary box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  ObjectSummary object;
  object.low = low;
  object.high = high;
  return object;
}

}  // namespace

TEST_CASE("taken places are those of a look at all boxes") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-8.0, 8.0), extent(0.1, 6.0);
  const auto any_box = [&] {
    const Eigen::Vector3d low(place(random), place(random), place(random) / 8.0);
    return box(low, low + Eigen::Vector3d(extent(random), extent(random), extent(random) / 3.0));
  };
  TakenPlaces places;
  std::vector<std::pair<std::size_t, ObjectSummary>> all;
  for (std::size_t i = 0; i < 400; ++i) {
    all.emplace_back(i % 60, any_box());
    places.add(all.back().first, all.back().second);
  }
  places.sort();
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const ObjectSummary object = any_box();
    std::set<std::size_t> scans;
    for (const auto& [scan, other] : all) {
      bool fills = true;
      for (int axis = 0; axis < 3; ++axis) {
        const double common = std::min(object.high[axis], other.high[axis]) -
                              std::max(object.low[axis], other.low[axis]) + 0.2;
        fills = fills && common >= 0.5 * (object.high[axis] - object.low[axis]);
      }
      if (fills) scans.insert(scan);
    }
    REQUIRE(places.scans_at(object, 0.2) == static_cast<int>(scans.size()));
    found += static_cast<int>(scans.size());
  }
  CHECK(found > 1000);
}

}  // namespace raymoval::raymoval_plus_test
