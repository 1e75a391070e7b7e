// SPDX-License-Identifier: MIT
// What is found by a short way equals what the slow and obvious way finds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "methods/common/sparse_blocks.h"
#include "methods/raymoval/consistency.h"
#include "methods/raymoval/static_map.h"
#include "methods/raymoval/validation.h"
#include "tests/methods/raymoval/random_map.h"
#include "tests/methods/raymoval/window_values.h"

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

TEST_CASE("a map holds the voxels that it was given and that were not erased since", "[raymoval]") {
  Random random(53);
  StaticMap map(0.2);
  std::map<VoxelKey, VoxelState> expected;
  for (int round = 0; round < 5; ++round) {
    std::vector<VoxelIndex> voxels;
    for (int k = 0; k < 300; ++k) {
      voxels.emplace_back(random.integer(-9, 9), random.integer(-9, 9), random.integer(-9, 9));
      expected.try_emplace(voxel_key(voxels.back()), VoxelState::kOccupied);
    }
    map.integrate(voxels);
    for (std::size_t k = 0; k < 50; ++k) {
      // Also voxels that were never filled: these stay empty and can be filled later.
      const VoxelIndex voxel = k % 2 == 0 ? voxels[k] : VoxelIndex(-voxels[k]);
      map.erase(voxel);
      const auto known = expected.find(voxel_key(voxel));
      if (known != expected.end()) known->second = VoxelState::kErased;
    }
    std::vector<VoxelIndex> all;
    for_each_around(VoxelIndex::Zero(), 9, [&](const VoxelIndex& at) { all.push_back(at); });
    VoxelLookup found;
    map.look_up(all, 1, found);
    std::size_t occupied = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto known = expected.find(voxel_key(all[k]));
      REQUIRE(found.states[k] == (known == expected.end() ? VoxelState::kEmpty : known->second));
      occupied += found.states[k] == VoxelState::kOccupied ? 1 : 0;
    }
    REQUIRE(map.occupied().size() == occupied);
  }
}

}  // namespace raymoval::raymoval_test
