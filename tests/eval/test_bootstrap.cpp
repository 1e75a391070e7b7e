// SPDX-License-Identifier: MIT
#include "eval/bootstrap.h"

#include <catch2/catch.hpp>
#include <map>
#include <numeric>

#include "eval/erasor/maps/truth_map.h"
#include "eval/erasor/matching.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/random_sequence.h"
#include "tests/eval/worked_example.h"

namespace raymoval::test {
namespace {

using Counts = std::vector<std::int64_t>;

std::vector<Rate> share(const Counts& sums) {
  return {percent_rate("share", sums[0], sums[1], "nothing there")};
}

/// One whole per scan, of which `parts` says how much is there.
std::vector<Counts> scans_of(const Counts& parts) {
  std::vector<Counts> scans;
  for (const std::int64_t part : parts) scans.push_back({part, 1});
  return scans;
}

const Interval& interval_named(const Intervals& intervals, const std::string& name) {
  for (const Interval& interval : intervals.rates) {
    if (interval.name == name) return interval;
  }
  throw InternalError("no interval " + name);
}

}  // namespace

TEST_CASE("a block is as long as the root of the number of scans, rounded up", "[bootstrap]") {
  CHECK(bootstrap_block(1) == 1);
  CHECK(bootstrap_block(4) == 2);
  CHECK(bootstrap_block(5) == 3);
  CHECK(bootstrap_block(77) == 9);
  CHECK(bootstrap_block(100) == 10);
}

TEST_CASE("blocks keep neighbours together and run on from the last scan", "[bootstrap]") {
  // Blocks of two. Alternating scans: each block, the one across the end too, holds one half.
  const Intervals even = bootstrap(scans_of({1, 0, 1, 0}), share);
  REQUIRE(even.block_scans == 2);
  CHECK(even.rates[0].low == 50.0);
  CHECK(even.rates[0].high == 50.0);
  // In a row: blocks hold 2, 1, 0 and 1; both blocks of a replicate are the full one once in 16
  // times, and the empty one as often, more than the 2.5 % that are cut off.
  const Intervals uneven = bootstrap(scans_of({1, 1, 0, 0}), share);
  CHECK(uneven.rates[0].low == 0.0);
  CHECK(uneven.rates[0].high == 100.0);
  // At a level of 50 % a quarter is cut off on either side. Sums of 0 to 4 have the chances 1, 4,
  // 6, 4 and 1 in 16: a quarter lies among the ones (6 % to 31 %), three quarters among the threes.
  BootstrapOptions half;
  half.level = 0.5;
  const Intervals inner = bootstrap(scans_of({1, 1, 0, 0}), share, half);
  CHECK(inner.rates[0].low == 25.0);
  CHECK(inner.rates[0].high == 75.0);
}

TEST_CASE("voxels belong to the scan that gave them their label", "[bootstrap][worked]") {
  const MemorySequence sequence = worked_example();
  const LabelClasses classes{LabelRule{}};
  const erasor::Options options;
  const EvaluationInput input = sequence.input();
  const erasor::MapRules rules{input, options, classes};
  const erasor::TruthMap truth(rules);
  std::map<VoxelKey, std::uint32_t> scan_of_cell;
  truth.cells().for_each([&](CellLattice::Number number, VoxelKey cell) {
    if (erasor::is_voxel(truth.mean(number))) scan_of_cell[cell] = truth.scan(number);
  });
  std::vector<std::uint32_t> scans;
  for (const auto& [cell, scan] : scan_of_cell) scans.push_back(scan);
  // In the order of the keys. (25, 0, 0) holds a point of either scan at equal distances: the first
  // one. (59, 0, 0) and (60, 0, 0) are of the second scan.
  CHECK(scans == std::vector<std::uint32_t>{0, 0, 1, 1, 0, 0, 0});
  const auto partners = erasor::partner_kinds(truth, truth, options, 1);
  const auto by_scan = erasor::count_matches_by_scan(truth, partners, 2, {});
  CHECK(by_scan[0] == erasor::MatchCounts{3, 2, 3, 2});
  CHECK(by_scan[1] == erasor::MatchCounts{1, 1, 1, 1});
}

TEST_CASE("intervals hold the rates and are the same for any number of threads", "[bootstrap]") {
  CloudShape shape;
  shape.scans = 30;
  shape.points = 400;
  const MemorySequence sequence = random_sequence(shape);
  EvaluationInput input = sequence.input();
  for (const auto& [protocol, rates] :
       std::vector<std::pair<const char*, std::vector<const char*>>>{
           {"erasor", {"PR", "RR", "F1"}}, {"dynamicmap", {"SA", "DA", "AA", "HA"}}}) {
    CAPTURE(protocol);
    input.threads = 1;
    const ProtocolResult one = score_by(protocol, input, sequence.masks());
    input.threads = 8;
    const ProtocolResult many = score_by(protocol, input, sequence.masks());
    REQUIRE(one.intervals.has_value());
    CHECK(one.intervals->block_scans == 6);
    CHECK(one.intervals->rates.size() == rates.size());
    for (const char* rate : rates) {
      CAPTURE(rate);
      const Interval& interval = interval_named(*one.intervals, rate);
      REQUIRE(interval.low.has_value());
      CHECK(*interval.low < one.rate(rate).value());
      CHECK(one.rate(rate).value() < *interval.high);
      CHECK(*interval.high - *interval.low < 20.0);
      CHECK(interval_named(*many.intervals, rate).low == interval.low);
      CHECK(interval_named(*many.intervals, rate).high == interval.high);
    }
  }
}

}  // namespace raymoval::test
