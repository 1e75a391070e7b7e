// SPDX-License-Identifier: MIT
// Cleaned clouds without labels: their scores, and errors for a broken cloud.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/points/cloud_masks.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/random_sequence.h"
#include "tests/eval/worked_example.h"

namespace raymoval::test {
namespace {

using Catch::Contains;
using Points = std::vector<Eigen::Vector3f>;

/// The points that a mask keeps, in the world frame.
Points kept_points(const MemorySequence& sequence, const MaskStore& masks) {
  Points points;
  for (std::size_t s = 0; s < sequence.size(); ++s) {
    const Mask mask = masks.get(s);
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const LabelledScan& scan = sequence.scans()[s];
      if (mask[i] == 0) points.push_back((scan.pose * scan.points[i].cast<double>()).cast<float>());
    }
  }
  return points;
}

Points shifted(Points points, const Eigen::Vector3f& offset) {
  for (Eigen::Vector3f& point : points) point += offset;
  return points;
}

ProtocolResult score_cloud(const std::string& name, const EvaluationInput& input,
                           const Points& cloud) {
  Settings settings;
  if (name == "erasor") settings = {{"label_mode", std::string("nearest")}, {"lift", 0.0}};
  return protocol_with(name, settings)->open(input)->score_cloud(CloudEstimate(cloud));
}

}  // namespace

TEST_CASE("the worked example's cloud scores as written for labels by nearest neighbour",
          "[cloud][worked]") {
  const MemorySequence sequence = worked_example();
  const EvaluationInput input = sequence.input();
  // The lift moves all points of a cell alike, so without it the matches are those of the
  // description. Its cloud holds one more voxel, that of point 1, which the truth crops.
  const Points cloud = kept_points(sequence, sequence.masks());
  const ProtocolResult method = score_cloud("erasor", input, cloud);
  CHECK(method.count("cloud_points") == 5);
  CHECK(method.count("estimate_voxels") == 5);
  CHECK(method.count("estimate_voxels_without_partner") == 1);
  CHECK(method.count("preserved_static") == 2);
  CHECK(method.count("remaining_dynamic") == 2);
  // Point 6 is in the cell of 4 and 5, so its label is that of their centroid: the ceiling.
  const Points best = kept_points(sequence, sequence.oracle_masks());
  const ProtocolResult ceiling = score_cloud("erasor", input, best);
  CHECK(ceiling.count("preserved_static") == 4);
  CHECK(ceiling.count("remaining_dynamic") == 1);
  CHECK(ceiling.rate("RR").value() == Approx(200.0 / 3));
  const ProtocolResult points = score_cloud("dynamicmap", input, cloud);
  CHECK(points.rate("SA") == 62.5);
  CHECK(points.rate("DA") == 75.0);
  // With cells of 0.1 m, point 2 counts as kept; point 10 keeps its cell as well.
  const ProtocolResult strict = score_cloud("dynamicmap-strict", input, cloud);
  CHECK(strict.count("preserved_static") == 4);
  CHECK(strict.count("remaining_dynamic") == 1);
}

TEST_CASE("an empty cloud keeps nothing", "[cloud][edge]") {
  const MemorySequence sequence = worked_example();
  const ProtocolResult voxels = score_cloud("erasor", sequence.input(), {});
  CHECK(voxels.rate("PR") == 0.0);
  CHECK(voxels.rate("RR") == 100.0);
  CHECK(voxels.rate("F1") == 0.0);
  REQUIRE(voxels.warnings.size() == 1);
  for (const char* name : {"dynamicmap", "dynamicmap-strict"}) {
    const ProtocolResult points = score_cloud(name, sequence.input(), {});
    CHECK(points.rate("SA") == 0.0);
    CHECK(points.rate("DA") == 100.0);
    CHECK(points.rate("HA") == 0.0);
    CHECK(points.warnings.size() == 1);
  }
}

TEST_CASE("a shifted cloud loses the static map, and is warned of", "[cloud][edge]") {
  const MemorySequence sequence = worked_example();
  const Points cloud = shifted(kept_points(sequence, sequence.oracle_masks()), {0.0f, 0.0f, 1.73f});
  const ProtocolResult voxels = score_cloud("erasor", sequence.input(), cloud);
  CHECK(voxels.count("cloud_points") == static_cast<std::int64_t>(cloud.size()));
  CHECK_THROWS_AS(voxels.count("removed_points"), InternalError);  // Unknown for clouds.
  CHECK(voxels.rate("PR") == 0.0);
  CHECK(voxels.rate("F1") == 0.0);
  REQUIRE(voxels.warnings.size() == 1);
  CHECK_THAT(voxels.warnings[0], Contains("same frame"));
  CHECK(score_cloud("dynamicmap", sequence.input(), cloud).rate("HA") == 0.0);
  CHECK(score_cloud("dynamicmap-strict", sequence.input(), cloud).rate("HA") == 0.0);
  // As if the cloud were in another coordinate system altogether.
  const Points far = shifted(cloud, {5e5f, 5e6f, 0.0f});
  CHECK(score_cloud("dynamicmap", sequence.input(), far).rate("SA") == 0.0);
  CHECK_THROWS_AS(score_cloud("erasor", sequence.input(), far), DataError);
  // A shift within the reach of 0.173 m costs nothing by voxels, but all by points.
  const Points near = shifted(kept_points(sequence, sequence.oracle_masks()), {0.0f, 0.0f, 0.06f});
  CHECK(score_cloud("erasor", sequence.input(), near).rate("PR") == 100.0);
  CHECK(score_cloud("dynamicmap", sequence.input(), near).rate("SA") == 0.0);
}

TEST_CASE("what lies nearest to an ignored point is ignored", "[cloud]") {
  // A mover was removed; 0.11 m beside it an ignored point is kept, in another cell.
  LabelledScan scan;
  scan.add(8.15f, 0.1f, 0.1f, 252, true);
  scan.add(8.26f, 0.1f, 0.1f, 99);
  scan.add(12.0f, 0.1f, 0.1f, 40);
  const MemorySequence sequence({scan});
  EvaluationInput input = sequence.input();
  input.label_rule.ignored = {99};
  const Points cloud = kept_points(sequence, sequence.masks());
  const ProtocolResult result = score_cloud("erasor", input, cloud);
  CHECK(result.count("estimate_voxels") == 1);
  CHECK(result.rate("RR") == 100.0);
  CHECK(result.rate("PR") == 100.0);
  // With no other label near, its voxel would have taken the mover's.
  LabelledScan unseen = scan;
  unseen.points.erase(unseen.points.begin() + 1);
  unseen.labels.erase(unseen.labels.begin() + 1);
  unseen.mask.erase(unseen.mask.begin() + 1);
  const MemorySequence other({unseen});
  CHECK(score_cloud("erasor", other.input(), cloud).rate("RR") == 0.0);
}

TEST_CASE("a cloud has no labels by index", "[cloud][edge]") {
  const MemorySequence sequence = worked_example();
  const auto scorer = erasor_protocol()->open(sequence.input());
  const Points none;
  CHECK_THROWS_AS(scorer->score_cloud(CloudEstimate(none)), UsageError);
}

TEST_CASE("masks of a cloud are what it lacks", "[cloud]") {
  CloudShape shape;
  shape.points = 500;
  shape.extent = 3.0f;
  const MemorySequence sequence = random_sequence(shape);
  EvaluationInput input = sequence.input();
  // With a distance of 1 mm, no point replaces another, so the masks are recovered.
  const Points cloud = kept_points(sequence, sequence.masks());
  for (const int threads : {1, 8}) {
    input.threads = threads;
    const MaskStore masks = masks_of_cloud(input, cloud, 0.001);
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      CHECK(masks.get(i) == sequence.masks().get(i));
    }
  }
  CHECK(masks_of_cloud(input, {{1e30f, 0.0f, 0.0f}}, 0.05).removed_count() == 1500);
}

}  // namespace raymoval::test
