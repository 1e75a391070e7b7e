// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/vote.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/raymoval_plus/evidence/located_scan.h"
#include "tests/methods/raymoval_plus/map_points.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// A row of voxels along x.
class Row {
  MapPoints points_;

 public:
  EvidenceMap& map = points_.map;

  /// @param agree_scans number of supporting scans
  std::uint32_t add(int cell, Verdict decision, int agree_scans = 0) {
    const auto voxel = points_.add(middle(cell));
    map.set_decision(voxel, decision);
    map.evidence(voxel).agree_scans = static_cast<std::uint16_t>(agree_scans);
    return voxel;
  }
  Verdict verdict(int cell) { return map.verdict(points_.find(middle(cell))); }

 private:
  static Eigen::Vector3d middle(int cell) { return {0.2 * cell + 0.1, 0.1, 0.1}; }
};

}  // namespace

TEST_CASE("a pole that scans always agreed with stays in a crowd") {
  // Static voxels at cell 0, dynamic voxels at the two on either side of each: 4 of 5 votes. The
  // crowd is there for as long as the pole was observed.
  const Parameters parameters;
  struct Pole {
    int agree_scans, free_scans;
    Verdict verdict;
  };
  for (const Pole pole :
       {Pole{parameters.settled_scans, 0, Verdict::kStatic},
        Pole{parameters.settled_scans - 1, 0, Verdict::kDynamic}, Pole{50, 1, Verdict::kDynamic}}) {
    Row row;
    for (const int cell : {-2, -1, 1, 2}) row.add(cell, Verdict::kDynamic, pole.agree_scans);
    VoxelEvidence& evidence = row.map.evidence(row.add(0, Verdict::kStatic, pole.agree_scans));
    evidence.free_scans = static_cast<std::uint16_t>(pole.free_scans);
    vote(parameters, RunContext{}, row.map);
    CHECK(row.verdict(0) == pole.verdict);
    CHECK(row.verdict(1) == Verdict::kDynamic);
  }
}

TEST_CASE("who passes a parked car does not outvote it") {
  // Two dynamic voxels on either side, with 2, 3, 7 and 8 supporting scans, 5 on average. Eight
  // times as many are 40. A few scans observed the car's place as free, so it was not always there.
  struct Car {
    int agree_scans;
    double outlast;
    Verdict verdict;
  };
  for (const Car car : {Car{41, 8.0, Verdict::kStatic}, Car{40, 8.0, Verdict::kDynamic},
                        Car{40, 7.9, Verdict::kStatic}, Car{400, 0.0, Verdict::kDynamic}}) {
    Row row;
    row.add(-2, Verdict::kDynamic, 2);
    row.add(-1, Verdict::kDynamic, 3);
    row.add(1, Verdict::kDynamic, 7);
    row.add(2, Verdict::kDynamic, 8);
    row.add(4, Verdict::kDynamic, 1000);  // It has no vote, being four cells away.
    row.map.evidence(row.add(0, Verdict::kStatic, car.agree_scans)).free_scans = 3;
    Parameters parameters;
    parameters.outlast = car.outlast;
    vote(parameters, RunContext{}, row.map);
    CHECK(row.verdict(0) == car.verdict);
    CHECK(row.verdict(1) == Verdict::kDynamic);
  }
}

TEST_CASE("what beams only passed beside is not outvoted by what passes it a few times") {
  // Two dynamic voxels on either side, with 20 supporting scans each. Three times as many are 60,
  // eight times 160. A twentieth of 60 or 61 scans is three.
  struct Pole {
    int agree_scans, free_scans, leading_free, trailing_free;
    Verdict verdict;
  };
  for (const Pole pole : {Pole{61, 3, 0, 0, Verdict::kStatic},      //
                          Pole{60, 3, 0, 0, Verdict::kDynamic},     // not more than three times
                          Pole{61, 4, 0, 0, Verdict::kDynamic},     // more than a twentieth
                          Pole{61, 1, 1, 0, Verdict::kDynamic},     // nothing was there before
                          Pole{61, 1, 0, 1, Verdict::kDynamic},     // it left
                          Pole{161, 1, 0, 1, Verdict::kStatic}}) {  // more than eight times
    Row row;
    for (const int cell : {-2, -1, 1, 2}) row.add(cell, Verdict::kDynamic, 20);
    VoxelEvidence& evidence = row.map.evidence(row.add(0, Verdict::kStatic, pole.agree_scans));
    evidence.free_scans = static_cast<std::uint16_t>(pole.free_scans);
    evidence.leading_free = static_cast<std::uint16_t>(pole.leading_free);
    evidence.trailing_free = static_cast<std::uint16_t>(pole.trailing_free);
    CAPTURE(pole.agree_scans, pole.free_scans, pole.leading_free, pole.trailing_free);
    vote(Parameters{}, RunContext{}, row.map);
    CHECK(row.verdict(0) == pole.verdict);
    CHECK(row.verdict(1) == Verdict::kDynamic);
  }
}

TEST_CASE("what few scans agree with is outvoted, however few agree with what is around it") {
  for (const int agree_scans : {9, 10}) {
    Row row;
    for (const int cell : {-1, 1}) row.add(cell, Verdict::kDynamic, 1);
    row.map.evidence(row.add(0, Verdict::kStatic, agree_scans)).free_scans = 1;
    vote(Parameters{}, RunContext{}, row.map);
    CHECK(row.verdict(0) == (agree_scans < 10 ? Verdict::kDynamic : Verdict::kStatic));
  }
}

TEST_CASE("neighbours outvote a voxel within three cells and no farther") {
  Row row;
  for (const int cell : {0, 1, 2, 3}) row.add(cell, Verdict::kDynamic);
  row.add(6, Verdict::kStatic);
  row.add(10, Verdict::kUndecided);
  vote(Parameters{}, RunContext{}, row.map);
  CHECK(row.verdict(0) == Verdict::kDynamic);
  CHECK(row.verdict(6) == Verdict::kDynamic);  // one dynamic voxel (3) of two within 3 cells: half
  CHECK(row.verdict(10) == Verdict::kUndecided);
}

TEST_CASE("however small the share is, a voxel without a dynamic one around it stays") {
  // Cells 0 to 3 are of one block, 4 to 7 of the next one. Cell 3 is within three cells of 6.
  Row row;
  row.add(3, Verdict::kDynamic);
  for (const int cell : {6, 7}) row.add(cell, Verdict::kStatic);
  Parameters parameters;
  parameters.vote_share =
      find_parameter("raymoval_plus", parameter_table().specs(), "vote_share").notes.minimum;
  vote(parameters, RunContext{}, row.map);
  CHECK(row.verdict(6) == Verdict::kDynamic);
  CHECK(row.verdict(7) == Verdict::kStatic);
}

TEST_CASE("only the blocks of a scan get new verdicts when it arrives") {
  // Cells 0 and 3 are of one block of 4 x 4 x 4, cell 20 is of another.
  Row row;
  LocatedScan scan;
  for (const int cell : {20, 0, 3}) scan.voxel.push_back(row.add(cell, Verdict::kDynamic));
  scan.voxel[0] = EvidenceMap::kNone;  // Ground.
  const auto blocks = blocks_of(scan.voxel, row.map);
  CHECK(blocks == std::vector{row.map.block_of(scan.voxel[1])});
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
    map.set_decision(voxel, k == 0   ? Verdict::kUndecided
                            : k == 1 ? Verdict::kDynamic
                                     : Verdict::kStatic);
  }
  const int radius = GENERATE(1, 2, 3, 4, 5, 8);
  Parameters parameters;
  parameters.vote_radius = radius;
  parameters.vote_share = parameters.vote_keep = 0.2;
  vote(parameters, RunContext{.threads = 2}, map);
  int wrong = 0, dynamic_verdicts = 0;
  for (std::size_t v = 0; v < map.size(); ++v) {
    int decided = 0, dynamic = 0;
    for (std::size_t w = 0; w < map.size(); ++w) {
      if ((map.index(v) - map.index(w)).cwiseAbs().maxCoeff() > radius) continue;
      decided += map.decision(w) != Verdict::kUndecided ? 1 : 0;
      dynamic += map.decision(w) == Verdict::kDynamic ? 1 : 0;
    }
    const bool expected = decided > 0 && dynamic >= 0.2 * decided;
    wrong += expected != (map.verdict(v) == Verdict::kDynamic) ? 1 : 0;
    dynamic_verdicts += expected ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(dynamic_verdicts > 100);
  CHECK(dynamic_verdicts < static_cast<int>(map.size()) - 100);
}

}  // namespace raymoval::raymoval_plus_test
