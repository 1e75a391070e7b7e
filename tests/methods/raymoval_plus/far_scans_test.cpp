// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/far_scans.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// The observation of a voxel by one scan, and its distance, metres.
struct Said {
  Observation observation;
  float range;
};

int free_scans(const std::vector<Said>& story, const Parameters& parameters = {}) {
  VoxelEvidence evidence;
  std::size_t scan = 0;
  for (const auto& [observation, range] : story) {
    add_observation({observation, range, scan++}, parameters, evidence);
  }
  return evidence.free_scans;
}

/// The rule of step 4, computed from all observations.
int free_scans_of_rule(const std::vector<Said>& story) {
  int agree = 0, heard = 0;
  std::size_t first = story.size(), last = 0;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < story.size(); ++k) {
    if (story[k].observation != Observation::kAgree) continue;
    ++agree;
    first = std::min(first, k);
    last = k;
    nearest = std::min(nearest, story[k].range);
  }
  for (std::size_t k = 0; k < story.size(); ++k) {
    if (story[k].observation != Observation::kFree) continue;
    float octave = 0.0F;
    for (const float from : {8.0F, 16.0F, 32.0F}) {
      if (story[k].range >= from) octave = from;
    }
    if (agree < 10 || k < first || k > last || octave <= 4.0F * nearest) ++heard;
  }
  return heard;
}

}  // namespace

TEST_CASE("who is far away is not heard of what others agree with near by") {
  using enum Observation;
  // Ten scans support it, the nearest from 3 m: free scans count up to the octave that begins at 8
  // m, because the next begins at 16 m, and four times 3 m is 12 m.
  std::vector<Said> story(10, {kAgree, 3.0F});
  story.front().range = 30.0F;
  for (const float range : {2.0F, 15.9F, 16.0F, 70.0F})
    story.insert(story.end() - 1, {kFree, range});
  CHECK(free_scans(story) == 2);
  // Before the first and after the last supporting scan, all free scans count.
  story.insert(story.begin(), {kFree, 70.0F});
  story.push_back({kFree, 70.0F});
  CHECK(free_scans(story) == 4);
  // What was after is between when one more agrees.
  story.push_back({kAgree, 3.0F});
  CHECK(free_scans(story) == 3);
  // With fewer supporting scans, and without settled voxels, all free scans count.
  Parameters parameters;
  for (const int settled : {0, 12}) {
    parameters.settled_scans = settled;
    CHECK(free_scans(story, parameters) == 6);
  }
}

TEST_CASE("scans are heard as the rule says of any story, from its end as well") {
  std::mt19937 random(20);
  std::uniform_real_distribution<float> exponent(0.0F, 6.3F);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Said> story(random() % 60);
    for (Said& said : story) {
      const auto kind = random() % 4;
      said = {kind < 2    ? Observation::kAgree
              : kind == 2 ? Observation::kFree
                          : Observation::kOccluded,
              std::exp2(exponent(random))};
    }
    const int wanted = free_scans_of_rule(story);
    REQUIRE(free_scans(story) == wanted);
    std::reverse(story.begin(), story.end());
    REQUIRE(free_scans(story) == wanted);
  }
}

}  // namespace raymoval::raymoval_plus_test
