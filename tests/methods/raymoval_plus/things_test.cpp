// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/things.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <string>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// Voxels with evidence, of which `find` finds the passes outside.
struct Things {
  explicit Things(double voxel_size = 0.2) : map(voxel_size) {}

  std::uint32_t add(const VoxelIndex& cell, const VoxelEvidence& evidence) {
    const std::uint32_t voxel = map.add(cell, 0x808080U, cursor);
    map.evidence(voxel) = evidence;
    return voxel;
  }
  void find() { find_passes_outside(all_blocks(map), RunContext{.threads = 2}, map); }
  [[nodiscard]] float passes(std::uint32_t voxel) const {
    return map.evidence(voxel).passes_outside;
  }

  EvidenceMap map;
  EvidenceMap::Blocks::Cursor cursor;
};

/// A voxel that was hit from scan `first` to scan `last`.
VoxelEvidence hit_in(std::uint32_t first, std::uint32_t last) {
  VoxelEvidence evidence;
  evidence.hits = static_cast<std::uint16_t>(last - first + 1);
  evidence.first_hit = first;
  evidence.last_hit = last;
  return evidence;
}

/// The passes outside of a voxel alone.
float passes_alone(const VoxelEvidence& evidence) {
  Things things;
  const std::uint32_t voxel = things.add({-3, 2, 0}, evidence);
  things.find();
  return things.passes(voxel);
}

}  // namespace

TEST_CASE("passes before a thing came and after it left are outside, four at most") {
  CHECK(passes_alone(evidence_of("pphhhhhp")) == 3.0F);
  CHECK(passes_alone(evidence_of("pppppphhhhhppppp")) == 4.0F);
  CHECK(passes_alone(evidence_of("hphphh")) == 0.0F);
  CHECK(passes_alone(evidence_of("ppp")) == 3.0F);  // Nothing was ever there.
}

TEST_CASE("what is open around a voxel of few hits counts as half a pass") {
  CHECK(passes_alone(evidence_of("oohhho")) == 1.5F);
  CHECK(passes_alone(evidence_of("oophhho")) == 2.5F);
  CHECK(passes_alone(evidence_of("oohhhho")) == 0.0F);  // Four hits.
}

TEST_CASE("firm voxels have no passes outside") {
  CHECK(passes_alone(evidence_of("phhhhhhhhhh")) == 0.0F);  // Ten hits.
  CHECK(passes_alone(evidence_of("phhhhhhhhh")) == 1.0F);
}

TEST_CASE("passes through a porous thing while it stands are not outside") {
  // A hedge: one voxel is hit from scan 0 to 99; another one from 4 to 96, with passes before and
  // after. Alone that has seven passes, of which four count.
  const std::string of_leaf = "pppph" + std::string(91, '.') + "hppp";
  const VoxelEvidence leaf = evidence_of(of_leaf);
  CHECK(passes_alone(leaf) == 4.0F);
  Things things;
  things.add({0, 0, 0}, hit_in(0, 99));
  const auto beside = things.add({2, 0, 1}, leaf);
  // Somebody stopped behind the hedge: 59 and 3 scans apart from it at the ends. Passes 0 to 3 and
  // 97 to 99 are outside.
  const auto other = things.add({0, 2, 0}, evidence_of("pppp" + std::string(56, '.') + "hhhhh"));
  things.find();
  CHECK(things.passes(beside) == 0.0F);
  CHECK(things.passes(other) == 4.0F);
}

TEST_CASE("voxels are of one thing if their ends are five scans and a tenth of both apart") {
  // Scans 100 to 119: 5 and a tenth of 20 are seven scans.
  struct Ends {
    std::uint32_t first, last;
    bool are_alike;
  };
  for (const auto& [first, last, are_alike] :
       {Ends{107, 119, true}, Ends{108, 119, false}, Ends{104, 116, true}, Ends{104, 115, false},
        Ends{104, 119, true}, Ends{100, 119, true}}) {
    Things things;
    things.add({4, 0, 0}, hit_in(100, 119));
    VoxelEvidence evidence = hit_in(first, last);
    evidence.hits = 5;
    evidence.passes_before = 2;
    evidence.first_passes = {102, 103};
    const auto voxel = things.add({3, 0, 0}, evidence);
    things.find();
    CAPTURE(first, last);
    CHECK(things.passes(voxel) == (are_alike || first < 104 ? 0.0F : 2.0F));
  }
}

TEST_CASE("voxels of a thing are at most 0.6 m apart, or one voxel") {
  struct Step {
    double voxel_size;
    VoxelIndex to;
    bool is_near;
  };
  for (const auto& [size, to, is_near] :
       {Step{0.2, {3, 0, 0}, true}, Step{0.2, {-2, 2, 1}, true}, Step{0.2, {2, -2, 2}, false},
        Step{0.2, {0, 0, -4}, false}, Step{0.1, {0, -6, 0}, true}, Step{0.1, {0, 0, 7}, false},
        Step{0.3, {0, 2, 0}, true}, Step{0.3, {2, 1, 0}, false}, Step{2.0, {0, 0, 1}, true},
        Step{2.0, {1, 1, 0}, false}}) {
    Things things(size);
    const VoxelIndex at(-1, 4, 2);
    const auto voxel = things.add(at, evidence_of("pphhhhhhhhhhhhhh"));
    things.add(at + to, hit_in(0, 15));
    things.find();
    CAPTURE(size, to);
    CHECK(things.passes(voxel) == (is_near ? 0.0F : 2.0F));
  }
}

TEST_CASE("a voxel that no scan hit may belong to everything near it") {
  Things things;
  const auto voxel = things.add({0, 0, 0}, evidence_of("ppp", 5));
  things.add({1, 0, 0}, hit_in(0, 6));
  things.find();
  CHECK(things.passes(voxel) == 1.0F);  // Scan 7.
  things.add({-1, 0, 0}, hit_in(40, 50));
  things.find();
  CHECK(things.passes(voxel) == 0.0F);
}

TEST_CASE("things are found as by a comparison of all voxels with each other") {
  const double size = GENERATE(0.1, 0.2, 0.3);
  std::mt19937 random(static_cast<unsigned>(1000.0 * size));
  Things things(size);
  std::uniform_int_distribution<int> place(-9, 9), from(0, 25), length(1, 25), kind(0, 9);
  for (int i = 0; i < 900; ++i) {
    const int first = from(random), last = first + length(random);
    std::string story;
    for (int scan = 0; scan < 55; ++scan) {
      const int seen = kind(random);  // Some stand always, and some are never hit.
      const bool is_there = (scan >= first && scan < last) || i % 9 > 5;
      story += seen < 7 ? '.' : is_there && i % 9 > 0 ? 'h' : seen == 9 ? 'o' : 'p';
    }
    things.add({place(random), place(random), place(random)}, evidence_of(story));
  }
  things.find();
  const EvidenceMap& map = things.map;
  int wrong = 0, of_things = 0;
  std::array<int, 10> found{};  // By passes outside, in halves.
  Surroundings around(size);
  for (std::uint32_t v = 0; v < map.size(); ++v) {
    const VoxelEvidence& own = map.evidence(v);
    Presence all;
    float sum = 0.0F;
    int voxels = 0;
    for (std::uint32_t w = 0; w < map.size(); ++w) {
      const VoxelEvidence& other = map.evidence(w);
      const double apart = size * (map.index(v) - map.index(w)).cast<double>().norm();
      if (other.hits == 0 || apart > 0.6 + 1e-9) continue;
      const double begin = std::min(own.first_hit, other.first_hit);
      const double end = std::max(own.last_hit, other.last_hit);
      const double ends = std::max(own.first_hit, other.first_hit) - begin + end -
                          std::min(own.last_hit, other.last_hit);
      if (own.hits > 0 && ends > 5.0 + 0.1 * (end - begin + 1.0)) continue;
      all = {std::min(all.first, other.first_hit), std::max(all.last, other.last_hit)};
      sum += other.passes_outside;
      ++voxels;
    }
    float expected =
        own.hits <= 3 ? 0.5F * static_cast<float>(own.open_before + own.open_after) : 0.0F;
    for (std::size_t i = 0; i < VoxelEvidence::kPasses; ++i) {
      if (i < own.passes_before && (own.first_passes[i] < all.first || own.first_passes[i] > all.last))
        expected += 1.0F;
      if (i < own.passes_after && (own.last_passes[i] < all.first || own.last_passes[i] > all.last))
        expected += 1.0F;
    }
    expected = is_firm(own) ? 0.0F : std::min(expected, 4.0F);
    around.look_at(map.block_of(v), map);
    const Presence presence = around.presence_of_thing(map.index(v));
    wrong += own.passes_outside != expected || presence.first != all.first ||
                     presence.last != all.last ||
                     around.passes_of_thing(map.index(v)) != sum / static_cast<float>(std::max(voxels, 1))
                 ? 1
                 : 0;
    ++found[static_cast<std::size_t>(2.0F * expected)];
    of_things += voxels > 1 ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(of_things > 100);
  CHECK(found[0] > 20);
  CHECK(found[8] > 20);
  CHECK(std::count_if(found.begin(), found.end(), [](int n) { return n > 0; }) > 5);
}

}  // namespace raymoval::raymoval_plus_test
