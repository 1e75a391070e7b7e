// SPDX-License-Identifier: MIT
// The maps that are added up scan by scan, against the same maps made of all points at once.
#include <catch2/catch.hpp>
#include <map>

#include "eval/checked_scan.h"
#include "eval/erasor/maps/estimate_map.h"
#include "eval/scan_passes.h"
#include "tests/eval/random_sequence.h"

namespace raymoval::test {
namespace {

using erasor::VoxelKind;

/// The dense map of what a mask leaves, and the scan of each of its points.
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

TEST_CASE("a mean that is rounded into the next cell is counted there", "[erasor][maps]") {
  // Three points of a scan a hair below the wall at x = 0.25, far from the origin: their mean may
  // be rounded on to the wall, and does so with other points removed than without.
  for (int turn = 0; turn < 40; ++turn) {
    LabelledScan scan;
    scan.pose.translation() = Eigen::Vector3d(4096.0, 0.0, 0.0);
    float below = 4.25f;
    for (int i = 0; i < 1 + turn % 5; ++i) below = std::nextafter(below, 0.0f);
    for (int i = 0; i < 3 + turn % 4; ++i) {
      scan.add(below, 0.125f, 0.125f, i % 2 == 0 ? 40 : 252, (turn >> i & 1) != 0);
    }
    scan.add(4.0625f, 0.125f, 0.125f, 40, turn % 2 == 0);
    scan.add(4.3125f, 0.125f, 0.125f, 252, turn % 3 == 0);
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(1e-9 * turn, Eigen::Vector3d::UnitZ()).matrix();
    scan.pose.linear() = rotation;
    const MemorySequence sequence({scan, scan});
    CAPTURE(turn);
    check_maps(sequence, sequence.input());
  }
}

}  // namespace raymoval::test
