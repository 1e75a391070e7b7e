// SPDX-License-Identifier: MIT
// Random clouds: the fast protocol beside the slow one, and what must hold for any input.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/eval/memory_sequence.h"
#include "tests/eval/random_sequence.h"
#include "tests/eval/slow_erasor.h"

namespace raymoval::test {
namespace {

EvaluationInput short_sighted(const MemorySequence& sequence) {
  EvaluationInput input = sequence.input();
  input.range_m = {2.9, 4.9};
  input.label_rule.ignored = {99};
  return input;
}

void check_against_slow(const MemorySequence& sequence, const SlowErasor::Options& options) {
  const EvaluationInput input = short_sighted(sequence);
  const auto text = [](bool value, const char* yes, const char* no) {
    return std::string(value ? yes : no);
  };
  const ProtocolResult fast =
      score_erasor(input, sequence.masks(),
                   {{"voxel_size", options.voxel_size},
                    {"label_rule", text(options.geometry, "geometry", "both")},
                    {"matching", text(options.same_cell, "same_cell", "radius")},
                    {"label_mode", text(options.nearest_labels, "nearest", "index")},
                    {"ignore_0_1", options.ignore_0_1}});
  const SlowErasor::Counts slow =
      SlowErasor(input, options).score(sequence.scans(), sequence.masks());
  CHECK(fast.count("static_voxels") == slow.static_voxels);
  CHECK(fast.count("dynamic_voxels") == slow.dynamic_voxels);
  CHECK(fast.count("preserved_static") == slow.preserved_static);
  CHECK(fast.count("remaining_dynamic") == slow.remaining_dynamic);
  CHECK(fast.count("estimate_voxels") == slow.estimate_voxels);
  CHECK(fast.count("estimate_voxels_without_partner") == slow.without_partner);
  CHECK(fast.count("mixed_label_ties") == slow.mixed_ties);
}

const SlowErasor::Options kVariants[] = {{},
                                         {0.2, true},
                                         {0.2, false, true},
                                         {0.2, false, false, true},
                                         {0.2, false, false, false, true}};

}  // namespace

TEST_CASE("random clouds score as the slow protocol says", "[erasor][oracle]") {
  for (unsigned seed = 0; seed < 8; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.extent = 0.4f + 0.15f * static_cast<float>(seed);
    const MemorySequence sequence = random_sequence(shape);
    for (const SlowErasor::Options& options : kVariants) {
      CAPTURE(seed, options.geometry, options.same_cell, options.nearest_labels);
      check_against_slow(sequence, options);
    }
  }
}

TEST_CASE("coordinates on cell walls score as the slow protocol says", "[erasor][oracle]") {
  for (unsigned seed = 100; seed < 108; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.coordinates = Coordinates::kOnWalls;
    const MemorySequence sequence = random_sequence(shape);
    for (SlowErasor::Options options : kVariants) {
      options.voxel_size = 0.25;
      CAPTURE(seed, options.geometry, options.same_cell, options.nearest_labels);
      check_against_slow(sequence, options);
    }
  }
}

TEST_CASE("a world 100 km away scores as the slow protocol says", "[erasor][oracle]") {
  for (unsigned seed = 200; seed < 204; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.offset = {100000.0, -100000.0, 1000.0};
    const MemorySequence sequence = random_sequence(shape);
    CAPTURE(seed);
    check_against_slow(sequence, {});
    check_against_slow(sequence, {0.2, false, false, true});
  }
}

TEST_CASE("beyond the lattice is an error and no wrap-around", "[erasor]") {
  CloudShape shape;
  shape.offset = {3e6, 0.0, 0.0};
  const MemorySequence sequence = random_sequence(shape);
  CHECK_THROWS_AS(score_erasor(sequence.input(), sequence.masks()), DataError);
}

TEST_CASE("the controls score what they must on any cloud", "[erasor]") {
  for (unsigned seed = 0; seed < 5; ++seed) {
    CAPTURE(seed);
    CloudShape shape;
    shape.seed = seed;
    const MemorySequence sequence = random_sequence(shape);
    const EvaluationInput input = short_sighted(sequence);
    const ProtocolResult noop = score_erasor(input, sequence.constant_masks(false));
    CHECK(noop.rate("PR") == 100.0);
    CHECK(noop.rate("RR") == 0.0);
    CHECK(noop.rate("F1") == 0.0);
    CHECK(noop.count("removed_points") == 0);
    CHECK(noop.count("estimate_voxels") ==
          noop.count("static_voxels") + noop.count("dynamic_voxels"));
    const ProtocolResult all = score_erasor(input, sequence.constant_masks(true));
    CHECK(all.rate("PR") == 0.0);
    CHECK(all.rate("RR") == 100.0);
    CHECK(all.rate("F1") == 0.0);
    CHECK(all.count("removed_points") == all.count("evaluated_points"));
    const ProtocolResult oracle = score_erasor(input, sequence.oracle_masks(input.label_rule));
    CHECK(oracle.rate("RR") == 100.0);
    CHECK(oracle.rate("PR").value() > 50.0);
  }
}

TEST_CASE("the number of threads changes nothing", "[erasor][slow]") {
  CloudShape shape;
  shape.scans = 20;
  shape.points = 8000;
  const MemorySequence sequence = random_sequence(shape);
  EvaluationInput input = short_sighted(sequence);
  for (const char* mode : {"index", "nearest"}) {
    const Settings settings = {{"label_mode", std::string(mode)}, {"voxel_size", 0.05}};
    input.threads = 1;
    const ProtocolResult one = score_erasor(input, sequence.masks(), settings);
    REQUIRE(one.count("estimate_voxels") > 40000);  // Several chunks.
    for (const int threads : {2, 8}) {
      input.threads = threads;
      const ProtocolResult many = score_erasor(input, sequence.masks(), settings);
      CHECK(many.counts == one.counts);
      CHECK(many.rate("PR") == one.rate("PR"));
    }
  }
}

TEST_CASE("the order of points within a scan does not matter without ties", "[erasor]") {
  // Large cells of many points each: two-point cells tie by construction and follow the order.
  const Settings settings = {{"voxel_size", 1.0}};
  CloudShape shape;
  shape.scans = 1;
  shape.points = 4000;
  shape.extent = 0.7f;
  const MemorySequence sequence = random_sequence(shape);
  std::mt19937 random(7);
  const MemorySequence other({shuffled(sequence.scans().front(), random)});
  const ProtocolResult before = score_erasor(sequence.input(), sequence.masks(), settings);
  REQUIRE(before.count("mixed_label_ties") == 0);
  REQUIRE(before.count("estimate_mixed_label_ties") == 0);
  CHECK(score_erasor(other.input(), other.masks(), settings).counts == before.counts);
}

}  // namespace raymoval::test
