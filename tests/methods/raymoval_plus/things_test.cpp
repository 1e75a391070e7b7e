// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/things.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <string>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A voxel that was hit from scan `first` to scan `last`.
VoxelEvidence hit_in(std::uint32_t first, std::uint32_t last) {
  return {
      .hits = static_cast<std::uint16_t>(last - first + 1), .first_hit = first, .last_hit = last};
}

/// Voxels at some cells, with what is known of them, of which the passes outside are found.
EvidenceMap things(double voxel_size,
                   const std::vector<std::pair<VoxelIndex, VoxelEvidence>>& voxels) {
  EvidenceMap map(voxel_size);
  EvidenceMap::Blocks::Cursor cursor;
  for (const auto& [cell, evidence] : voxels) map.evidence(map.add(cell, 0, cursor)) = evidence;
  find_passes_outside(all_blocks(map), RunContext{.threads = 2}, map);
  return map;
}

/// The passes outside of a voxel, alone or with another one `step` cells away.
float passes(const VoxelEvidence& evidence) {
  return things(0.2, {{{-3, 2, 0}, evidence}}).evidence(0).passes_outside;
}
float passes(const VoxelEvidence& evidence, const VoxelEvidence& other,
             const VoxelIndex& step = {1, 0, 0}, double voxel_size = 0.2) {
  const VoxelIndex at(-1, 4, 2);
  return things(voxel_size, {{at, evidence}, {at + step, other}}).evidence(0).passes_outside;
}

}  // namespace

TEST_CASE("passes before a thing came and after it left are outside, four at most") {
  CHECK(passes(evidence_of("pphhhhhp")) == 3.0F);
  CHECK(passes(evidence_of("pppppphhhhhppppp")) == 4.0F);
  CHECK(passes(evidence_of("hphphh")) == 0.0F);
  CHECK(passes(evidence_of("ppp")) == 3.0F);  // Nothing was ever there.
  // What is open counts half, if few scans hit the voxel.
  CHECK(passes(evidence_of("oophhho")) == 2.5F);
  CHECK(passes(evidence_of("oophhhho")) == 1.0F);
  // Firm voxels, hit by ten scans, have none.
  CHECK(passes(evidence_of("phhhhhhhhhh")) == 0.0F);
  CHECK(passes(evidence_of("phhhhhhhhh")) == 1.0F);
}

TEST_CASE("passes through a porous thing while it stands are not outside") {
  // A hedge: one voxel is hit from scan 0 to 99; another one from 4 to 96, with four passes before
  // and three after.
  const VoxelEvidence leaf = evidence_of("pppph" + std::string(91, '.') + "hppp");
  CHECK(passes(leaf) == 4.0F);
  CHECK(passes(leaf, hit_in(0, 99)) == 0.0F);
  // Somebody stopped before the hedge at scan 60.
  CHECK(passes(evidence_of("pppp" + std::string(56, '.') + "hhhhh"), hit_in(0, 99)) == 4.0F);
}

TEST_CASE("voxels are of one thing if their ends are five scans and a tenth of both apart") {
  // Scans 100 to 119: 5 and a tenth of 20 are seven scans. Two passes, before the voxel was hit.
  for (const auto& [first, last, are_alike] :
       {std::tuple{107U, 119U, true}, std::tuple{108U, 119U, false}, std::tuple{104U, 116U, true},
        std::tuple{104U, 115U, false}}) {
    VoxelEvidence evidence = evidence_of("pp", 102);
    evidence.hits = 5;
    evidence.first_hit = first;
    evidence.last_hit = last;
    CAPTURE(first, last);
    CHECK(passes(evidence, hit_in(100, 119)) == (are_alike ? 0.0F : 2.0F));
  }
}

TEST_CASE("voxels of a thing are at most 0.6 m apart, or one voxel") {
  using Step = std::tuple<double, VoxelIndex, bool>;
  for (const auto& [size, step, is_near] :
       {Step{0.2, {3, 0, 0}, true}, Step{0.2, {-2, 2, 1}, true}, Step{0.2, {2, -2, 2}, false},
        Step{0.2, {0, 0, -4}, false}, Step{0.1, {0, -6, 0}, true}, Step{0.1, {0, 0, 7}, false},
        Step{0.3, {0, 2, 0}, true}, Step{0.3, {2, 1, 0}, false}, Step{2.0, {0, 0, 1}, true},
        Step{2.0, {1, 1, 0}, false}}) {
    CAPTURE(size, step.transpose());
    const VoxelEvidence evidence = evidence_of("pphhhhhhhhhhhhhh");
    CHECK(passes(evidence, hit_in(0, 15), step, size) == (is_near ? 0.0F : 2.0F));
  }
}

TEST_CASE("a voxel that no scan hit may belong to everything near it") {
  const VoxelEvidence evidence = evidence_of("ppp", 5);
  CHECK(passes(evidence, hit_in(0, 6)) == 1.0F);  // Scan 7.
  CHECK(
      things(0.2, {{{0, 0, 0}, evidence}, {{1, 0, 0}, hit_in(0, 6)}, {{-1, 0, 0}, hit_in(40, 50)}})
          .evidence(0)
          .passes_outside == 0.0F);
}

namespace {

/// The thing at a voxel, by a comparison with all other voxels.
struct SlowThing {
  Presence presence;
  float passes = 0.0F;
  int voxels = 0;

  SlowThing(const EvidenceMap& map, std::uint32_t v) {
    const VoxelEvidence& own = map.evidence(v);
    for (std::uint32_t w = 0; w < map.size(); ++w) {
      const VoxelEvidence& other = map.evidence(w);
      const double cells = (map.index(v) - map.index(w)).cast<double>().norm();
      if (other.hits == 0 || map.voxel_size() * cells > 0.6 + 1e-9) continue;
      const double begin = std::min(own.first_hit, other.first_hit);
      const double end = std::max(own.last_hit, other.last_hit);
      const double apart = std::max(own.first_hit, other.first_hit) - begin + end -
                           std::min(own.last_hit, other.last_hit);
      if (own.hits > 0 && apart > 5.0 + 0.1 * (end - begin + 1.0)) continue;
      presence.first = std::min(presence.first, other.first_hit);
      presence.last = std::max(presence.last, other.last_hit);
      passes += other.passes_outside;
      ++voxels;
    }
  }
  [[nodiscard]] float passes_outside(const VoxelEvidence& own) const {
    if (is_firm(own)) return 0.0F;
    int halves = own.hits <= 3 ? own.open_before + own.open_after : 0;
    for (std::size_t i = 0; i < VoxelEvidence::kPasses; ++i) {
      for (const auto& [count, scan] : {std::pair{own.passes_before, own.first_passes[i]},
                                        std::pair{own.passes_after, own.last_passes[i]}}) {
        if (i < count && (scan < presence.first || scan > presence.last)) halves += 2;
      }
    }
    return 0.5F * static_cast<float>(std::min(halves, 8));
  }
};

}  // namespace

TEST_CASE("things are found as by a comparison of all voxels with each other") {
  const double size = GENERATE(0.1, 0.2, 0.3);
  std::mt19937 random(static_cast<unsigned>(1000.0 * size));
  std::uniform_int_distribution<int> place(-9, 9), from(0, 25), length(1, 25), kind(0, 9);
  std::vector<std::pair<VoxelIndex, VoxelEvidence>> voxels;
  for (int i = 0; i < 900; ++i) {
    const int first = from(random), last = first + length(random);
    std::string story;
    for (int scan = 0; scan < 55; ++scan) {
      const int seen = kind(random);  // Some stand always, and some are never hit.
      const bool is_there = (scan >= first && scan < last) || i % 9 > 5;
      story += seen < 7 ? '.' : is_there && i % 9 > 0 ? 'h' : seen == 9 ? 'o' : 'p';
    }
    const VoxelIndex cell(place(random), place(random), place(random));
    voxels.emplace_back(cell, evidence_of(story));
  }
  const EvidenceMap map = things(size, voxels);
  int wrong = 0, of_things = 0;
  std::array<int, 9> found{};  // By passes outside, in halves.
  Surroundings around(size);
  for (std::uint32_t v = 0; v < map.size(); ++v) {
    const SlowThing thing(map, v);
    const float outside = map.evidence(v).passes_outside;
    around.look_at(map.block_of(v), map);
    const Presence presence = around.presence_of_thing(map.index(v));
    const float mean = thing.passes / static_cast<float>(std::max(thing.voxels, 1));
    wrong += outside != thing.passes_outside(map.evidence(v)) ? 1 : 0;
    wrong += presence.first != thing.presence.first || presence.last != thing.presence.last ? 1 : 0;
    wrong += around.passes_of_thing(map.index(v), map) != mean ? 1 : 0;
    ++found[static_cast<std::size_t>(2.0F * outside)];
    of_things += thing.voxels > 1 ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(of_things > 100);
  CHECK(found[0] > 20);
  CHECK(found[8] > 20);
  CHECK(std::count(found.begin(), found.end(), 0) < 4);
}

}  // namespace raymoval::raymoval_plus_test
