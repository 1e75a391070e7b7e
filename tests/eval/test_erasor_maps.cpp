// SPDX-License-Identifier: MIT
// The maps that are added up scan by scan, against the same maps made of all points at once.
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "eval/checked_scan.h"
#include "eval/erasor/maps/estimate_map.h"
#include "eval/scan_passes.h"
#include "tests/eval/random_sequence.h"

namespace raymoval::test {
namespace {

using erasor::VoxelKind;

/// The dense map of the kept points of a mask, and the scan of each of its points.
struct WholeDenseMap {
  LabelledCloud cloud;
  std::vector<std::uint32_t> scans;
  std::int64_t ties = 0;

  WholeDenseMap(const erasor::MapRules& rules, const MaskStore& masks) {
    for (std::size_t i = 0; i < rules.input.scans->size(); ++i) {
      const CheckedScan scan = load_checked(rules.input, &masks, i);
      const LabelledVoxels voxels =
          voxelise(erasor::place_scan(scan, rules), rules.options.voxel_size, rules.classes, 1);
      cloud.append(voxels.cloud);
      scans.resize(cloud.size(), static_cast<std::uint32_t>(i));
      ties += voxels.mixed_label_ties;
    }
  }
};

/// Checks that `map` has the voxels of `expected`, bit by bit. @param exact or only whether it
/// moves
void check_same(const erasor::MapVoxels& map, const LabelledVoxels& expected,
                const LabelClasses& classes, bool exact) {
  std::map<VoxelKey, CellLattice::Number> numbers;
  map.cells().for_each([&](CellLattice::Number number, VoxelKey cell) {
    if (erasor::is_voxel(map.mean(number))) numbers[cell] = number;
  });
  REQUIRE(numbers.size() == expected.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto found = numbers.find(expected.keys[i]);
    REQUIRE(found != numbers.end());
    const VoxelKind kind = map.kind(found->second);
    VoxelKind wanted = erasor::kind_of(expected.cloud.labels[i], classes);
    if (!exact && wanted == VoxelKind::kUnlabelled && kind == VoxelKind::kStatic) wanted = kind;
    same += map.mean(found->second) == expected.cloud.points[i] && kind == wanted ? 1 : 0;
  }
  CHECK(same == expected.size());
}

void check_maps(const MemorySequence& sequence, const EvaluationInput& input) {
  erasor::Options options;
  options.voxel_size = 0.25;
  options.lift = 0.0;
  const LabelClasses classes(input.label_rule);
  const erasor::MapRules rules{input, options, classes};
  const erasor::TruthMap truth(rules);
  const WholeDenseMap whole(rules, sequence.constant_masks(false));
  const LabelledVoxels all = voxelise(whole.cloud, options.voxel_size, classes, 1);
  check_same(truth, all, classes, true);
  CHECK(truth.mixed_label_ties() == whole.ties + all.mixed_label_ties);
  CellLattice::Cursor cursor;
  std::size_t of_same_scan = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto number = truth.cells().find(all.keys[i], cursor);
    of_same_scan += truth.scan(number) == whole.scans[all.label_points[i]] ? 1 : 0;
  }
  CHECK(of_same_scan == all.size());
  for (const MaskStore& masks :
       {sequence.masks(), sequence.constant_masks(false), sequence.constant_masks(true),
        sequence.oracle_masks(input.label_rule)}) {
    erasor::EstimateMap estimate(rules, truth);
    run_passes(input, masks, {&estimate});
    const WholeDenseMap left(rules, masks);
    const LabelledVoxels expected = voxelise(left.cloud, options.voxel_size, classes, 1);
    check_same(estimate, expected, classes, false);
    CHECK(estimate.mixed_label_ties() == left.ties + expected.mixed_label_ties);
  }
}

}  // namespace

TEST_CASE("maps added up scan by scan are those of all points at once", "[erasor][maps]") {
  for (unsigned seed = 0; seed < 24; ++seed) {
    CloudShape shape;
    shape.seed = seed;
    shape.scans = 5;
    shape.points = seed % 2 == 0 ? 150 : 700;
    if (seed % 3 == 2) shape.coordinates = Coordinates::kOnWalls;
    if (seed >= 12) shape.offset = {40000.1, -40000.3, 1000.0};
    const MemorySequence sequence = random_sequence(shape);
    EvaluationInput input = sequence.input();
    input.threads = seed % 4 == 3 ? 4 : 1;
    CAPTURE(seed);
    check_maps(sequence, input);
  }
}

TEST_CASE("a mean never leaves the cell of its points", "[erasor][maps]") {
  // Points within a few units in the last place of a wall, on either side, near the origin and far
  // from it: however many there are, their mean is rounded to no other cell.
  std::mt19937 random(17);
  for (const double size : {0.2, 0.25, 0.1, 0.07}) {
    for (int turn = 0; turn < 20000; ++turn) {
      const int cell = static_cast<int>(random() % 4001) - 2000;
      const double wall = cell * size * (turn % 3 == 0 ? 1.0 : 37.0);
      std::map<VoxelKey, OffsetMean> means;
      for (unsigned i = 0; i < 2 + random() % 7; ++i) {
        double x = wall;
        for (unsigned k = random() % 4; k > 0; --k)
          x = std::nextafter(x, random() % 2 ? 1e9 : -1e9);
        const Eigen::Vector3d point(x, -x, 0.5 * size);
        means[cell_key(point, 1.0 / size)].add(point);
      }
      for (const auto& [key, mean] : means) REQUIRE(cell_key(mean.mean(), 1.0 / size) == key);
    }
  }
}

}  // namespace raymoval::test
