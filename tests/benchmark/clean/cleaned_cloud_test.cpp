// SPDX-License-Identifier: MIT
#include "benchmark/clean/cleaned_cloud.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "benchmark/run/scored_sequence.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "tests/benchmark/small_world.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Three scans of the street with both protocols, as `raymoval score --cloud` sets them up.
ScoredSequence street_sequence() {
  SequenceOptions options;
  options.frames = parse_frame_range("0:2");
  Suite suite;
  add_protocol(suite, "erasor", "");
  set_parameter(suite.protocols[0].options, "label_mode", std::string("nearest"));
  set_parameter(suite.protocols[0].options, "lift", 0.0);
  add_protocol(suite, "dynamicmap", "");
  return {open_sequence("street", options), suite.protocols, 1, nullptr};
}

ProtocolResult score(ScoredSequence& scored, std::size_t protocol, const CleanedCloud& cloud) {
  return scored.score_cloud(protocol, CloudEstimate(cloud.points));
}

bool same_counts(ScoredSequence& scored, const CleanedCloud& a, const CleanedCloud& b) {
  bool same = true;
  for (std::size_t i = 0; i < scored.protocol_count(); ++i) {
    same = same && score(scored, i, a).counts == score(scored, i, b).counts;
  }
  return same;
}

}  // namespace

TEST_CASE("A cloud of NaNs wins nothing: it scores as the empty cloud and says so") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const test::TemporaryFolder folder;
  for (const char* name : {"nan.pcd", "nan.ply", "nan.bin"}) {
    test::write_cloud(folder.path() / name,
                      {{nan, nan, nan}, {1.0f, nan, 0.0f}, {0.0f, 0.0f, infinite}});
    const CleanedCloud cloud = read_cleaned_cloud(folder.path() / name);
    CHECK(cloud.stored == 3);
    CHECK(cloud.non_finite == 3);
    CHECK(cloud.points.empty());
    REQUIRE(cloud.warnings().size() == 2);
    CHECK_THAT(cloud.warnings()[0], Contains("3 of 3 points"));
    CHECK_THAT(cloud.warnings()[1], Contains("no point"));
  }
  ScoredSequence scored = street_sequence();
  const CleanedCloud nothing = cleaned_cloud({{nan, nan, nan}});
  const ProtocolResult voxels = score(scored, 0, nothing);
  CHECK(voxels.rate("PR") == 0.0);
  CHECK(voxels.rate("RR") == 100.0);
  CHECK(voxels.rate("F1") == 0.0);
  const ProtocolResult points = score(scored, 1, nothing);
  CHECK(points.rate("SA") == 0.0);
  CHECK(points.rate("HA") == 0.0);
}

TEST_CASE("The order of a cloud's points and NaNs among them change no score") {
  ScoredSequence scored = street_sequence();
  const CleanedCloud cloud = oracle_cloud(scored.sequence(), 0.0, nullptr);
  REQUIRE(cloud.points.size() > 1000);
  std::vector<Eigen::Vector3f> points = cloud.points;
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  points.insert(points.begin() + 500, Eigen::Vector3f::Constant(std::nanf("")));
  const CleanedCloud shuffled = cleaned_cloud(points);
  CHECK(shuffled.points == cloud.points);
  CHECK(shuffled.warnings().size() == 1);
  CHECK(same_counts(scored, cloud, shuffled));
}

TEST_CASE("The oracle's cloud is near perfect, and a shifted one is not") {
  ScoredSequence scored = street_sequence();
  const CleanedCloud cloud = oracle_cloud(scored.sequence(), 0.0, nullptr);
  CHECK(cloud.warnings().empty());
  CHECK(score(scored, 0, cloud).rate("PR").value() > 95.0);
  CHECK(score(scored, 0, cloud).rate("RR").value() > 50.0);
  CHECK(score(scored, 1, cloud).rate("SA") == 100.0);
  std::vector<Eigen::Vector3f> points = cloud.points;
  for (Eigen::Vector3f& point : points) point += Eigen::Vector3f(0.0f, 0.0f, 100.0f);
  const CleanedCloud shifted = cleaned_cloud(points);
  const ProtocolResult result = score(scored, 0, shifted);
  CHECK(result.rate("F1") == 0.0);
  REQUIRE_FALSE(result.warnings.empty());
  CHECK_THAT(result.warnings.back(), Contains("same frame"));
  CHECK(score(scored, 1, shifted).rate("SA") == 0.0);
  // Thinned to 0.2 m: fewer points, which costs SA but hardly any PR.
  const CleanedCloud thin = oracle_cloud(scored.sequence(), 0.2, nullptr);
  CHECK(thin.points.size() < cloud.points.size());
  CHECK(score(scored, 1, thin).rate("SA").value() < 90.0);
  CHECK(score(scored, 0, thin).rate("PR").value() > 90.0);
  // Nothing was removed, and the protocol that counts points loses some to the thinning.
  const CleanedCloud whole = whole_cloud(scored.sequence(), 0.2, nullptr);
  CHECK(score(scored, 0, whole).rate("RR") == 0.0);
  CHECK(score(scored, 1, whole).rate("DA").value() > 10.0);
}
