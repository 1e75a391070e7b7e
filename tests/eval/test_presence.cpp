// SPDX-License-Identifier: MIT
// The search for kept points near flagged ones, in as little memory as there is.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/dynamicmap/presence.h"
#include "eval/scan_passes.h"
#include "tests/eval/random_sequence.h"

namespace raymoval::test {
namespace {

using namespace dynamicmap;

/// Counts how often the scans were shown.
struct CountedPasses : ScanVisitor {
  explicit CountedPasses(ScanVisitor& counted) : inner(counted) {}
  bool begin_pass(std::size_t slots) override {
    const bool goes_on = inner.begin_pass(slots);
    passes += goes_on ? 1 : 0;
    return goes_on;
  }
  void read(const CheckedScan& scan, std::size_t slot) override { inner.read(scan, slot); }
  void take(std::size_t slot) override { inner.take(slot); }

  ScanVisitor& inner;
  int passes = 0;
};

struct Counted {
  std::vector<std::int64_t> present, removed;
  int passes = 0;
};

Counted count(const EvaluationInput& input, const MaskStore& masks, const Options& options,
              const PresenceCount::Room& room) {
  const TruthPoints truth(input, 0.0, options.ego_range);
  const FineGrid grid(options.distance);
  const TruthBlocks blocks = truth_blocks(truth, grid);
  const auto presence = PresenceCount::start({truth, options, grid, blocks}, room);
  CountedPasses passes(*presence);
  run_passes(input, masks, {&passes});
  Counted counted;
  counted.passes = passes.passes;
  for (const ScanPresence& scan : presence->finish()) {
    counted.present.push_back(scan.present_static);
    counted.removed.push_back(scan.removed_dynamic);
  }
  return counted;
}

}  // namespace

TEST_CASE("with little room the search takes more passes and finds the same",
          "[dynamicmap][slow]") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.scans = 6;
    shape.points = 600;
    if (seed % 3 == 2) shape.coordinates = Coordinates::kOnWalls;
    const MemorySequence sequence = random_sequence(shape);
    EvaluationInput input = sequence.input();
    input.threads = seed % 2 == 0 ? 1 : 4;
    Options options;
    options.distance = seed % 2 == 0 ? 0.05 : 0.1;
    CAPTURE(seed);
    const Counted usual = count(input, sequence.masks(), options, {});
    CHECK(usual.passes == 3);
    const auto check_same = [&](const PresenceCount::Room& room, int fewest_passes) {
      const Counted other = count(input, sequence.masks(), options, room);
      CHECK(other.passes > fewest_passes);
      CHECK(other.present == usual.present);
      CHECK(other.removed == usual.removed);
      return other.passes;
    };
    const int narrow = check_same({.points = 4000}, 4);
    // Room for nothing: one block at a time.
    check_same({.points = 1}, narrow);
    const int ranges = check_same({.marks = 50000}, 4);
    check_same({.marks = 20000}, ranges);
    check_same({.marks = 50000, .points = 2000}, ranges - 1);
  }
}

TEST_CASE("points out of range may lie beyond the lattice", "[dynamicmap]") {
  LabelledScan scan;
  scan.add(5.0f, 0.0f, 0.0f, 40, true);
  scan.add(5.01f, 0.0f, 0.0f, 40);
  scan.add(9.0f, 0.0f, 0.0f, 252, true);
  scan.add(3e6f, 0.0f, 0.0f, 40);
  scan.add(0.0f, -3e6f, 0.0f, 252, true);
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  CHECK_THROWS_AS(score_by("dynamicmap", input, sequence.masks()), DataError);
  input.range_m = {0.0, 50.0};
  const ProtocolResult result = score_by("dynamicmap", input, sequence.masks());
  CHECK(result.count("present_static_points") == 2);
  CHECK(result.count("removed_dynamic_points") == 1);
  CHECK(result.count("out_of_range_points") == 2);
}

}  // namespace raymoval::test
