// SPDX-License-Identifier: MIT
// The memory of scoring, as reported by `bytes`: bounded by the map, for any answer and any number
// of points in a voxel.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "eval/dynamicmap/presence.h"
#include "eval/erasor/maps/estimate_map.h"
#include "eval/scan_passes.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {
namespace {

/// Checks the memory after each scan.
class Watched : public ScanVisitor {
 public:
  Watched(ScanVisitor& inner, std::function<void()> look) : inner_(inner), look_(std::move(look)) {}
  bool begin_pass(std::size_t slots) override {
    const bool goes_on = inner_.begin_pass(slots);
    look_();
    return goes_on;
  }
  void read(const CheckedScan& scan, std::size_t slot) override { inner_.read(scan, slot); }
  void take(std::size_t slot) override {
    inner_.take(slot);
    look_();
  }

 private:
  ScanVisitor& inner_;
  std::function<void()> look_;
};

/// A floor of 12 m x 12 m: 3,600 voxels of 0.2 m, half of them with moving points. In each scan
/// `points` lie in every voxel, and `flagged` of all are removed.
MemorySequence floor_scans(std::size_t points, double flagged) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> place(0.01f, 0.19f);
  std::bernoulli_distribution is_flagged(flagged);
  std::vector<LabelledScan> all(8);
  for (LabelledScan& scan : all) {
    for (std::size_t i = 0; i < 3600 * points; ++i) {
      const float x = 0.2f * static_cast<float>(i % 60), y = 0.2f * static_cast<float>(i / 60 % 60);
      scan.add(x + place(random), y + place(random), place(random),
               x > 6.0f && random() % 4 == 0 ? 252 : 40, is_flagged(random));
    }
  }
  return MemorySequence(std::move(all));
}

struct Memory {
  std::size_t voxels = 0;
  std::size_t erasor = 0, dynamicmap = 0;  ///< Bytes, at most; with the truth.

  /// Both protocols are open at a time.
  [[nodiscard]] double bytes_per_voxel() const {
    return static_cast<double>(erasor + dynamicmap) / static_cast<double>(voxels);
  }
};

Memory memory_of_scoring(const MemorySequence& sequence) {
  EvaluationInput input = sequence.input();
  Memory memory;
  const auto note = [](std::size_t& most, std::size_t bytes) { most = std::max(most, bytes); };

  erasor::Options options;
  options.minimum_horizontal_range = 0.0;
  options.lift = 0.0;
  const LabelClasses classes(input.label_rule);
  const erasor::MapRules rules{input, options, classes};
  const erasor::TruthMap map(rules);
  memory.voxels = static_cast<std::size_t>(map.voxels());
  erasor::EstimateMap estimate(rules, map);
  Watched watched_map(estimate, [&] { note(memory.erasor, map.bytes() + estimate.bytes()); });

  const dynamicmap::Options presence_options;
  const dynamicmap::TruthPoints truth(input, 0.0, 0.0);
  const dynamicmap::FineGrid grid(presence_options.distance);
  const dynamicmap::TruthBlocks blocks = truth_blocks(truth, grid);
  const std::size_t count = blocks.blocks.size();
  // As little as large maps have, which small ones are spared.
  const auto presence = dynamicmap::PresenceCount::start(
      {truth, presence_options, grid, blocks},
      {.marks = dynamicmap::PresenceCount::kMarksPerBlock * count,
       .points = dynamicmap::PresenceCount::kPointsPerBlock * count});
  Watched watched_presence(
      *presence, [&] { note(memory.dynamicmap, blocks.blocks.bytes() + presence->bytes()); });

  run_passes(input, sequence.masks(), {&watched_map, &watched_presence});
  return memory;
}

}  // namespace

TEST_CASE("scoring takes at most 150 bytes a voxel, whatever is removed", "[memory]") {
  for (const double flagged : {0.02, 0.3, 0.9}) {
    CAPTURE(flagged);
    const Memory memory = memory_of_scoring(floor_scans(1, flagged));
    REQUIRE(memory.voxels == 3600);
    CHECK(memory.bytes_per_voxel() < 150.0);
  }
}

TEST_CASE("scoring takes no more memory where more points lie in the voxels", "[memory]") {
  const Memory few = memory_of_scoring(floor_scans(1, 0.9));
  const Memory many = memory_of_scoring(floor_scans(2, 0.9));
  REQUIRE(many.voxels == few.voxels);
  CHECK(many.erasor == few.erasor);
  CHECK(many.dynamicmap <= few.dynamicmap * 5 / 4);
}

}  // namespace raymoval::test
