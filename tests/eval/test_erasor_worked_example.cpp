// SPDX-License-Identifier: MIT
// The worked example of the protocol's description: 12 points in two scans, of which one is too
// near; 7 voxels of truth, 4 static and 3 moving.
#include <catch2/catch.hpp>

#include "eval/erasor/maps/accumulate.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/worked_example.h"

namespace raymoval::test {
namespace {

struct Expected {
  const char* name;
  MaskStore masks;
  const char* label_mode;
  std::int64_t estimate_voxels, preserved_static, remaining_dynamic;
  double PR, RR, F1;
};

}  // namespace

TEST_CASE("the worked example scores as written", "[erasor][worked]") {
  const MemorySequence sequence = worked_example();
  const Expected rows[] = {
      {"by index", sequence.masks(), "index", 4, 2, 1, 50.0, 200.0 / 3, 4.0 / 7},
      {"by nearest", sequence.masks(), "nearest", 4, 2, 2, 50.0, 100.0 / 3, 0.4},
      {"nothing removed", sequence.constant_masks(false), "index", 7, 4, 3, 100.0, 0.0, 0.0},
      {"all removed", sequence.constant_masks(true), "index", 0, 0, 0, 0.0, 100.0, 0.0},
      {"oracle", sequence.oracle_masks(), "index", 5, 4, 0, 100.0, 100.0, 1.0},
      {"oracle by nearest", sequence.oracle_masks(), "nearest", 5, 4, 1, 100.0, 200.0 / 3, 0.8},
  };
  for (const Expected& row : rows) {
    CAPTURE(row.name);
    const ProtocolResult result =
        score_erasor(sequence.input(), row.masks, {{"label_mode", std::string(row.label_mode)}});
    CHECK(result.protocol == "erasor");
    CHECK(result.count("static_voxels") == 4);
    CHECK(result.count("dynamic_voxels") == 3);
    CHECK(result.count("estimate_voxels") == row.estimate_voxels);
    CHECK(result.count("preserved_static") == row.preserved_static);
    CHECK(result.count("remaining_dynamic") == row.remaining_dynamic);
    CHECK(result.rate("PR").value() == Approx(row.PR).margin(1e-9));
    CHECK(result.rate("RR").value() == Approx(row.RR).margin(1e-9));
    CHECK(result.rate("F1").value() == Approx(row.F1).margin(1e-9));
    CHECK(result.count("evaluated_points") == 11);
    CHECK(result.count("cropped_points") == 1);
    CHECK(result.count("ignored_points") == 0);
    CHECK(result.count("out_of_range_points") == 0);
    CHECK(result.count("estimate_voxels_without_partner") == 0);
    CHECK(result.warnings.size() == (row.estimate_voxels == 0 ? 1 : 0));
  }
}

TEST_CASE("the worked example's truth has the cells, centroids and labels as written",
          "[erasor][worked]") {
  const MemorySequence sequence = worked_example();
  const LabelClasses classes{LabelRule{}};
  const EvaluationInput input = sequence.input();
  const erasor::Options options;
  const LabelledCloud dense = erasor::dense_map({input, options, classes}, "test");
  CHECK(dense.size() == 8);
  const LabelledVoxels truth = voxelise(dense, 0.2, classes, 1);
  struct Voxel {
    VoxelIndex cell;
    Eigen::Vector3d centroid;
    std::uint32_t id;
  };
  // In the order of the keys: z, then y, then x.
  const std::vector<Voxel> expected = {
      {{-31, -16, 0}, {-6.05, -3.05, 0.10}, 50}, {{25, 0, 0}, {5.085, 0.085, 0.10}, 40},
      {{59, 0, 0}, {11.95, 0.05, 0.10}, 253},    {{60, 0, 0}, {12.05, 0.05, 0.10}, 40},
      {{-1, 30, 0}, {-0.05, 6.10, 0.10}, 254},   {{0, 30, 0}, {0.05, 6.10, 0.10}, 48},
      {{40, 10, 5}, {8.09, 2.09, 1.10}, 252}};
  REQUIRE(truth.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(voxel_index(truth.keys[i]) == expected[i].cell);
    CHECK((truth.cloud.points[i] - expected[i].centroid).norm() < 1e-6);
    CHECK(semantic_id(truth.cloud.labels[i]) == expected[i].id);
  }
}

TEST_CASE("the worked example by the other rules", "[erasor][worked]") {
  const MemorySequence sequence = worked_example();
  // By geometry, every voxel with a partner within 0.173 m is still there, with any label: all
  // except
  // (-31, -16, 0) have one.
  const ProtocolResult geometry =
      score_erasor(sequence.input(), sequence.masks(), {{"label_rule", std::string("geometry")}});
  CHECK(geometry.count("preserved_static") == 3);
  CHECK(geometry.count("remaining_dynamic") == 3);
  // By cells: (25, 0, 0) and (0, 30, 0) are kept, (60, 0, 0) has lost its points; of the moving
  // ones (59, 0, 0) remains, (40, 10, 5) holds a static point only and (-1, 30, 0) nothing.
  const ProtocolResult cells =
      score_erasor(sequence.input(), sequence.masks(), {{"matching", std::string("same_cell")}});
  CHECK(cells.count("preserved_static") == 2);
  CHECK(cells.count("remaining_dynamic") == 1);
  // By cells and geometry (40, 10, 5) counts as remaining too.
  const ProtocolResult both = score_erasor(
      sequence.input(), sequence.masks(),
      {{"matching", std::string("same_cell")}, {"label_rule", std::string("geometry")}});
  CHECK(both.count("preserved_static") == 2);
  CHECK(both.count("remaining_dynamic") == 2);
}

}  // namespace raymoval::test
