// SPDX-License-Identifier: MIT
// Counts around the size of the parts that threads take.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/raymoval/consistency.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

TEST_CASE("every point and bin is tested, however many there are", "[raymoval]") {
  // Around the size of the parts that threads take: all but every third are dynamic, or seen
  // through.
  for (const std::size_t count : {1, 2, 17, 8191, 8192, 8193, 16385, 20011}) {
    ProjectedScan scan;
    Mask expected(count, 1);
    std::vector<int> through;
    const std::vector<float> reference(count, 10.0F);
    for (std::size_t k = 0; k < count; ++k) {
      if (k % 3 == 1) expected[k] = 0;
      scan.range.push_back(expected[k] == 1 ? 5.0F : 9.9F);
      scan.bin.push_back(static_cast<std::int32_t>(k));
      scan.minimum_range.push_back(expected[k] == 1 ? 20.0F : kNoRange);
      if (expected[k] == 1) through.push_back(static_cast<int>(k));
    }
    FirstHitImage hits;
    hits.range = reference;
    INFO(count);
    CHECK(check_consistency(scan, reference, {1.0, 0.1}, 2) == expected);
    std::vector<int> found;
    const BinWindow alone{{static_cast<int>(count), 1, 0.0, 0.1}, 0, 0};
    for (const SeenThrough& at : find_seen_through(scan, alone, hits, reference, {1.0, 0.1}, 2)) {
      found.push_back(at.bin);
    }
    CHECK(found == through);
  }
}

TEST_CASE("scans of more points than a thread takes are in the bins of their points",
          "[raymoval]") {
  const AngularGrid grid{90, 20, -0.5, 0.5};
  for (const std::size_t count : {1, 8193, 16389}) {
    Scan scan;
    for (std::size_t k = 0; k < count; ++k) {
      const double turn = 0.01 * static_cast<double>(k), range = 4.0 + static_cast<double>(k % 7);
      scan.points.emplace_back(
          Eigen::Vector3d(range * std::cos(turn), range * std::sin(turn), 0.3).cast<float>());
    }
    ProjectedScan projected;
    project(scan, grid, 4.5, 2, projected);
    std::vector<float> nearest(static_cast<std::size_t>(grid.size()), kNoRange);
    for (std::size_t k = 0; k < count; ++k) {
      const Spherical at = to_spherical(scan.points[k].cast<double>());
      const int bin = at.range < 4.5 ? -1 : grid.bin_of(at.azimuth, at.elevation).value_or(-1);
      REQUIRE(projected.bin[k] == bin);
      REQUIRE(projected.range[k] == static_cast<float>(at.range));
      if (bin < 0) continue;
      float& least = nearest[static_cast<std::size_t>(bin)];
      least = std::min(least, projected.range[k]);
    }
    CHECK(projected.minimum_range == nearest);
  }
}

}  // namespace raymoval::raymoval_test
