// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

#include "core/error.h"
#include "eval/columns/columns.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

constexpr std::uint32_t word(std::uint32_t semantic, std::uint32_t instance) {
  return instance << 16U | semantic;
}

/// @param removed of `points`
void add_object(LabelledScan& scan, std::uint32_t label, int points, int removed) {
  for (int i = 0; i < points; ++i) scan.add(10.0f, 0.01f * float(i), 0.0f, label, i < removed);
}

std::map<std::string, Share> shares(const MemorySequence& sequence, const MaskStore& masks) {
  std::map<std::string, Share> found;
  for (const ColumnValue& value : column_values(tally_removals(sequence.input(), masks))) {
    found[value.name] = value.share;
  }
  return found;
}

void check(const std::map<std::string, Share>& found, const std::string& name, std::int64_t part,
           std::int64_t whole) {
  CAPTURE(name);
  REQUIRE(found.count(name) == 1);
  CHECK(found.at(name).part == part);
  CHECK(found.at(name).whole == whole);
}

/// The same from lists of the points of each object, without tallies.
std::map<std::string, Share> slow_shares(const MemorySequence& sequence, const MaskStore& masks) {
  std::map<std::uint32_t, std::vector<bool>> removed;  // Of each point, by label word.
  const EvaluationInput input = sequence.input();
  for (std::size_t s = 0; s < input.scans->size(); ++s) {
    const Scan scan = input.scans->load(s);
    const auto labels = input.labels->labels(scan);
    const Mask mask = masks.get(s);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double range = scan.points[i].cast<double>().norm();
      if (labels[i] >> 16U == 0 || !input.range_m.contains(range)) continue;
      if (scan.points[i].head<2>().cast<double>().norm() < 2.7) continue;
      removed[labels[i]].push_back(mask[i] != 0);
    }
  }
  Share mean, worst, below, trails;
  for (const auto& [label, points] : removed) {
    const auto size = static_cast<std::int64_t>(points.size());
    if (size < 200) continue;
    const auto gone = std::count(points.begin(), points.end(), true);
    if ((label & 0xFFFFU) >= 252) {
      trails.part += 100 * gone >= 95 * size ? 1 : 0;
      ++trails.whole;
      continue;
    }
    // Car and person, and the labels of those that move.
    const std::uint32_t moving = (label & 0xFFFFU) == 10 ? 252U : 254U;
    if (removed.count((label & 0xFFFF0000U) | moving) != 0) continue;
    const double kept = static_cast<double>(size - gone) / static_cast<double>(size);
    mean.part += std::llround(1e6 * kept);
    mean.whole += 1'000'000;
    if (worst.whole == 0 || kept < static_cast<double>(worst.part) / double(worst.whole)) {
      worst = {size - gone, size};
    }
    below.part += 100 * (size - gone) < 95 * size ? 1 : 0;
    ++below.whole;
  }
  return {
      {"parked", mean}, {"parked worst", worst}, {"parked below 95 %", below}, {"trails", trails}};
}

}  // namespace

TEST_CASE("parked objects and trails are counted by instance", "[columns]") {
  LabelledScan first, second;
  add_object(first, word(10, 1), 300, 30);  // Keeps 270 + 100 of 400 points: 92.5 %.
  add_object(second, word(10, 1), 100, 0);
  add_object(first, word(10, 2), 200, 10);     // Keeps exactly 95 %.
  add_object(first, word(10, 3), 199, 199);    // Too few points.
  add_object(first, word(10, 4), 400, 400);    // Moves later, so it is not parked.
  add_object(second, word(252, 4), 200, 190);  // Exactly 95 % is removed.
  add_object(second, word(254, 5), 400, 379);
  add_object(second, word(40, 0), 400, 400);  // No instance.
  const MemorySequence sequence({first, second});
  const auto found = shares(sequence, sequence.masks());
  check(found, "parked", 925'000 + 950'000, 2'000'000);
  check(found, "parked worst", 370, 400);
  check(found, "parked below 95 %", 1, 2);
  check(found, "trails", 1, 2);
}

TEST_CASE("without instances there are no columns of objects", "[columns]") {
  LabelledScan scan;
  add_object(scan, word(10, 0), 300, 0);
  add_object(scan, word(252, 0), 300, 0);
  const MemorySequence sequence({scan});
  const auto found = shares(sequence, sequence.masks());
  for (const char* name : {"parked", "parked worst", "parked below 95 %", "trails"}) {
    CHECK(found.count(name) == 0);
  }
}

TEST_CASE("columns of objects agree with lists of their points", "[columns]") {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    std::vector<LabelledScan> scans(3);
    for (LabelledScan& scan : scans) {
      for (int object = 0; object < 12; ++object) {
        const std::uint32_t semantic = std::vector<std::uint32_t>{10, 252, 254, 30}[random() % 4];
        const int points = static_cast<int>(random() % 250);
        const int removed = static_cast<int>(random() % 8) * points / 7;
        add_object(scan, word(semantic, 1 + random() % 6), points, removed);
      }
    }
    const MemorySequence sequence(scans);
    const auto found = shares(sequence, sequence.masks());
    for (const auto& [name, share] : slow_shares(sequence, sequence.masks())) {
      if (share.whole != 0) check(found, name, share.part, share.whole);
    }
  }
}

}  // namespace raymoval::test
