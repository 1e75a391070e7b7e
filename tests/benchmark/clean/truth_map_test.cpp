// SPDX-License-Identifier: MIT
// A labelled map in place of the scans that it was made of.
#include "datasets/truth_map.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "benchmark/clean/cleaned_cloud.h"
#include "benchmark/run/scored_sequence.h"
#include "core/error.h"
#include "core/scan/local_frame.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// Ten static points and four moving ones, each in a voxel of its own.
std::vector<Eigen::Vector3f> map_points() {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 14; ++i) points.emplace_back(0.1F + static_cast<float>(i), 0.1F, 0.1F);
  return points;
}

std::vector<float> labels_of(float standing, float moving) {
  std::vector<float> labels(14, standing);
  std::fill(labels.begin() + 10, labels.end(), moving);
  return labels;
}

ProtocolResult score_map(const std::filesystem::path& truth, const std::filesystem::path& cleaned,
                         const std::string& protocol) {
  Suite suite;
  add_protocol(suite, protocol, "");
  if (protocol == "erasor") {
    set_parameter(suite.protocols[0].options, "label_mode", std::string("nearest"));
    set_parameter(suite.protocols[0].options, "lift", 0.0);
  }
  ScoredSequence scored(open_truth_map(truth, {}), suite.protocols, 1, nullptr);
  const auto cloud = read_cleaned_cloud(cleaned, lattice_origin(*scored.sequence().scans));
  return scored.score_cloud(0, CloudEstimate(cloud.points));
}

}  // namespace

TEST_CASE("a labelled map is scored against itself and against parts of it", "[score]") {
  const TemporaryFolder folder;
  const auto points = map_points();
  // DynamicMap's labels, and ERASOR's map: SemanticKITTI's road and moving car.
  for (const auto& [standing, moving] : {std::pair(0.0F, 1.0F), std::pair(40.0F, 252.0F)}) {
    write_cloud(folder / "truth.ply", points, labels_of(standing, moving));
    const ProtocolResult itself = score_map(folder / "truth.ply", folder / "truth.ply", "erasor");
    CHECK(itself.rate("PR").value() == Approx(100.0));
    CHECK(itself.rate("RR").value() == Approx(0.0));
    // Without one static and three moving points.
    const std::vector<Eigen::Vector3f> kept(points.begin() + 1, points.begin() + 11);
    write_cloud(folder / "cleaned.ply", kept);
    const ProtocolResult cleaned =
        score_map(folder / "truth.ply", folder / "cleaned.ply", "erasor");
    for (const auto& [name, count] : cleaned.counts) UNSCOPED_INFO(name << " " << count);
    CHECK(cleaned.rate("PR").value() == Approx(90.0));
    CHECK(cleaned.rate("RR").value() == Approx(75.0));
    const ProtocolResult by_points =
        score_map(folder / "truth.ply", folder / "cleaned.ply", "dynamicmap");
    CHECK(by_points.rate("SA").value() == Approx(90.0));
    CHECK(by_points.rate("DA").value() == Approx(75.0));
  }
}

TEST_CASE("a map without labels, or with what is none, is refused", "[score]") {
  const TemporaryFolder folder;
  write_cloud(folder / "plain.ply", map_points());
  CHECK_THROWS_WITH(open_truth_map(folder / "plain.ply", {}),
                    Catch::Contains("no intensity") && Catch::Contains("--sequence"));
  write_cloud(folder / "strength.ply", map_points(), labels_of(0.25F, 0.5F));
  CHECK_THROWS_AS(score_map(folder / "strength.ply", folder / "strength.ply", "erasor"), DataError);
  CHECK_THROWS_AS(open_truth_map(folder / "none.ply", {}), DataError);
}
