// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/vote.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A row of voxels along x.
class Row {
  MapPoints points_;

 public:
  EvidenceMap& map = points_.map;

  std::uint32_t add(int cell, Verdict decision, int hits = 3, int passes = 0) {
    const auto voxel = points_.add(middle(cell));
    map.set_decision(voxel, decision);
    map.evidence(voxel).hits = static_cast<std::uint16_t>(hits);
    map.evidence(voxel).passes_after = static_cast<std::uint16_t>(passes);
    return voxel;
  }
  Verdict verdict(int cell) { return map.verdict(points_.find(middle(cell))); }

 private:
  static Eigen::Vector3d middle(int cell) { return {0.2 * cell + 0.1, 0.1, 0.1}; }
};

}  // namespace

TEST_CASE("a firm voxel keeps its decision in a crowd") {
  // A pole at cell 0, dynamic voxels at the two on either side: 4 of 5 votes.
  for (const auto& [hits, passes, verdict] :
       {std::tuple{10, 1, Verdict::kStatic}, std::tuple{10, 2, Verdict::kDynamic},
        std::tuple{9, 0, Verdict::kDynamic}}) {
    Row row;
    for (const int cell : {-2, -1, 1, 2}) row.add(cell, Verdict::kDynamic);
    row.add(0, Verdict::kStatic, hits, passes);
    vote(Parameters{}, RunContext{}, row.map);
    CHECK(row.verdict(0) == verdict);
    CHECK(row.verdict(1) == Verdict::kDynamic);
  }
}

TEST_CASE("only the blocks of a scan get new verdicts when it arrives") {
  // Cells 0 and 3 are of one block of 4 x 4 x 4, cell 20 is of another.
  Row row;
  std::vector<std::uint32_t> voxels;
  for (const int cell : {20, 0, 3}) voxels.push_back(row.add(cell, Verdict::kDynamic));
  voxels[0] = EvidenceMap::kNone;  // Ground.
  const auto blocks = blocks_of(voxels, row.map);
  CHECK(blocks == std::vector{row.map.block_of(voxels[1])});
  vote(blocks, Parameters{}, RunContext{}, row.map);
  CHECK(row.verdict(0) == Verdict::kDynamic);
  CHECK(row.verdict(20) == Verdict::kUndecided);
}

TEST_CASE("votes are those of a count over all voxels, whatever the radius") {
  std::mt19937 random(7);
  MapPoints points;
  EvidenceMap& map = points.map;
  std::uniform_int_distribution<int> place(-11, 12), kind(0, 5);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d point(place(random), place(random), place(random));
    const auto voxel = points.add(0.2 * (point + Eigen::Vector3d::Constant(0.5)));
    const int k = kind(random);
    map.set_decision(voxel, k < 3 ? Verdict{static_cast<std::uint8_t>(k)} : Verdict::kStatic);
    map.evidence(voxel).hits = i % 7 == 0 ? 10 : 9;  // Some are firm.
  }
  const int radius = GENERATE(1, 2, 3, 4, 5, 8);
  Parameters parameters;
  parameters.vote_radius = radius;
  parameters.vote_share = 0.2;  // A dynamic voxel needs 0.3.
  vote(parameters, RunContext{.threads = 2}, map);
  int wrong = 0, dynamic_verdicts = 0, kept = 0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    int decided = 0, dynamic = 0;
    for (std::size_t w = 0; w < map.size(); ++w) {
      if ((map.index(v) - map.index(w)).cwiseAbs().maxCoeff() > radius) continue;
      decided += map.decision(w) != Verdict::kUndecided ? 1 : 0;
      dynamic += map.decision(w) == Verdict::kDynamic ? 1 : 0;
    }
    const bool was_dynamic = map.decision(v) == Verdict::kDynamic;
    bool expected = decided > 0 && dynamic >= (was_dynamic ? 0.3 : 0.2) * decided;
    if (is_firm(map.evidence(v)) && expected != was_dynamic) {
      expected = was_dynamic;
      ++kept;
    }
    wrong += expected != (map.verdict(v) == Verdict::kDynamic) ? 1 : 0;
    dynamic_verdicts += expected ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(kept > 10);
  CHECK(dynamic_verdicts > 100);
  CHECK(dynamic_verdicts < static_cast<int>(map.size()) - 100);
}

}  // namespace raymoval::raymoval_plus_test
