// SPDX-License-Identifier: MIT
// What is found by a short way equals what the slow and obvious way finds.
#include <algorithm>
#include <catch2/catch.hpp>

#include "methods/raymoval/consistency.h"
#include "methods/raymoval/static_map.h"
#include "methods/raymoval/validation.h"
#include "tests/methods/raymoval/random_map.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;
using random_map::Random;

namespace {

/// Multiples of 1/4 below `most`, so that values meet and margins are hit exactly.
std::vector<float> random_ranges(int bins, double share_of_none, int most, Random& random) {
  std::vector<float> values;
  for (int bin = 0; bin < bins; ++bin) {
    const bool is_none = random.real(0, 1) < share_of_none;
    values.push_back(is_none ? kNoRange : 0.25F * static_cast<float>(random.integer(1, 4 * most)));
  }
  return values;
}

/// The values within so many columns and rows of a bin.
std::vector<float> values_around(const std::vector<float>& values, const BinWindow& window,
                                 int bin) {
  const AngularGrid& grid = window.grid;
  std::vector<float> around;
  for (int dj = -window.elevation_radius; dj <= window.elevation_radius; ++dj) {
    for (int di = -window.azimuth_radius; di <= window.azimuth_radius; ++di) {
      const int n = grid.azimuth_bins, j = grid.elevation_of(bin) + dj;
      if (j < 0 || j >= grid.elevation_bins) continue;
      const int i = ((grid.azimuth_of(bin) + di) % n + n) % n;
      around.push_back(values[static_cast<std::size_t>(j * n + i)]);
    }
  }
  return around;
}

}  // namespace

TEST_CASE("bins seen through are those whose whole neighbourhood lies behind", "[raymoval]") {
  Random random(41);
  std::size_t total = 0;
  for (int round = 0; round < 30; ++round) {
    const BinWindow window{{random.integer(4, 70), random.integer(1, 12), 0.0, 0.3},
                           random.integer(0, 2),
                           random.integer(0, 4)};
    const int bins = window.grid.size();
    ProjectedScan scan;
    scan.minimum_range = random_ranges(bins, 0.3, 20, random);
    for (float& value : scan.minimum_range) {
      if (value != kNoRange && random.integer(0, 9) > 0) value += 20;  // Mostly behind.
    }
    FirstHitImage hits;
    hits.range = random_ranges(bins, 0.1, 20, random);
    const std::vector<float> reference = random_ranges(bins, 0.1, 20, random);
    const RangeMargin margin{0.5, 0.25};
    std::vector<SeenThrough> expected;
    for (int bin = 0; bin < bins; ++bin) {
      const auto at = static_cast<std::size_t>(bin);
      const auto around = values_around(scan.minimum_range, window, bin);
      const float nearest = *std::min_element(around.begin(), around.end());
      if (scan.minimum_range[at] == kNoRange || hits.range[at] == kNoRange ||
          reference[at] == kNoRange)
        continue;
      if (nearest - reference[at] > 0.5 + 0.25 * reference[at] && nearest - hits.range[at] > 0.5) {
        expected.push_back({bin, nearest});
      }
    }
    total += expected.size();
    INFO("round " << round);
    const auto found = find_seen_through(scan, window, hits, reference, margin, 2);
    REQUIRE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                       [](const SeenThrough& a, const SeenThrough& b) {
                         return a.bin == b.bin && a.nearest_return == b.nearest_return;
                       }));
  }
  CHECK(total > 100);
}

TEST_CASE("components join all voxels within the gap, and no others", "[raymoval]") {
  Random random(47);
  for (int round = 0; round < 40; ++round) {
    const int gap = random.integer(1, 3), reach = random.integer(2, 12);
    std::vector<VoxelKey> voxels;
    for (int k = random.integer(0, 80); k > 0; --k) {
      voxels.push_back(voxel_key(random.integer(-reach, reach), random.integer(-reach, reach),
                                 random.integer(-reach, reach)));
      if (random.integer(0, 2) == 0) voxels.push_back(voxels.back());
    }
    // Each element takes the lowest number of those near it, until nothing changes.
    std::vector<std::size_t> lowest(voxels.size());
    for (std::size_t i = 0; i < lowest.size(); ++i) lowest[i] = i;
    for (bool changes = true; changes;) {
      changes = false;
      for (std::size_t i = 0; i < voxels.size(); ++i) {
        for (std::size_t j = 0; j < voxels.size(); ++j) {
          const VoxelIndex apart = voxel_index(voxels[i]) - voxel_index(voxels[j]);
          if (apart.cwiseAbs().maxCoeff() > gap || lowest[j] >= lowest[i]) continue;
          lowest[i] = lowest[j];
          changes = true;
        }
      }
    }
    std::vector<int> expected(voxels.size());
    int next = 0;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      expected[i] = lowest[i] == i ? next++ : expected[lowest[i]];
    }
    REQUIRE(voxel_components(voxels, gap) == expected);
  }
}

TEST_CASE("a map takes many voxels as it takes them one by one", "[raymoval]") {
  Random random(53);
  StaticMap one_by_one(0.2), at_once(0.2);
  for (int round = 0; round < 5; ++round) {
    std::vector<VoxelIndex> voxels;
    for (int k = 0; k < 300; ++k) {
      voxels.emplace_back(random.integer(-9, 9), random.integer(-9, 9), random.integer(-9, 9));
    }
    for (const VoxelIndex& voxel : voxels) one_by_one.integrate(voxel);
    at_once.integrate(voxels);
    for (int k = 0; k < 50; ++k) {
      for (StaticMap* map : {&one_by_one, &at_once})
        map->erase(voxels[static_cast<std::size_t>(k)]);
    }
    REQUIRE(at_once.occupied().size() == one_by_one.occupied().size());
    for (int x = -9; x <= 9; ++x) {
      for (int y = -9; y <= 9; ++y) {
        for (int z = -9; z <= 9; ++z) {
          REQUIRE(at_once.occupied().contains({x, y, z}) ==
                  one_by_one.occupied().contains({x, y, z}));
          REQUIRE(at_once.was_erased({x, y, z}) == one_by_one.was_erased({x, y, z}));
        }
      }
    }
  }
}

}  // namespace raymoval::raymoval_test
