// SPDX-License-Identifier: MIT
// The votes of many voxels at a time, against those of one voxel that keeps all candidates.
#include <catch2/catch.hpp>
#include <random>

#include "eval/lattice/label_votes.h"
#include "eval/points/nearest_points.h"

namespace raymoval::test {

TEST_CASE("votes that keep no points decide as the vote that keeps them", "[votes]") {
  std::mt19937 random(11);
  const auto below = [&](unsigned count) { return static_cast<unsigned>(random() % count); };
  std::size_t ties = 0, held_by_earlier = 0;
  for (int turn = 0; turn < 4000; ++turn) {
    CAPTURE(turn);
    LabelVote slow;
    LabelVotes fast(3);
    std::vector<bool> moving;
    double nearest = 1.0;
    // Distances in steps of a fraction of the margin, so that many are in reach of each other.
    const double step = kLabelTieMargin / (1 + below(4));
    for (std::uint32_t i = 0; i < 1 + below(12); ++i) {
      const double distance = 0.1 + step * below(8);
      moving.push_back(below(2) == 0);
      slow.offer(distance * distance, i);
      fast.offer(1, std::sqrt(distance * distance), {static_cast<std::uint16_t>(i), i + 100},
                 moving.back());
      nearest = std::min(nearest, std::sqrt(distance * distance));
    }
    const LabelVote::Result expected = slow.decide([&](std::uint32_t i) { return moving[i]; });
    REQUIRE(fast.label(1).id == expected.point);
    REQUIRE(fast.label(1).scan == expected.point + 100);
    REQUIRE(fast.is_mixed_tie(1) == expected.mixed_tie);
    ties += expected.mixed_tie ? 1 : 0;
    held_by_earlier += expected.point > 0 ? 1 : 0;
  }
  CHECK(ties > 500);
  CHECK(held_by_earlier > 500);
  CHECK_FALSE(LabelVotes(1).is_mixed_tie(0));
}

}  // namespace raymoval::test
