// SPDX-License-Identifier: MIT
// Outputs of a run besides masks: the reason of each point, and the timed stages.
#include <catch2/catch.hpp>
#include <map>
#include <numbers>
#include <set>

#include "core/stage_timer.h"
#include "tests/methods/raymoval/box_scenes.h"

namespace raymoval::raymoval_test {

namespace {

/// Ten scans of a wall, and before it a box in the first five. The sensor looks `turn` to the left.
World box_before_wall(double wall_top = 3.0, double turn = 0.0) {
  const Pose left(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
  return box_before(
      {wall(wall_top)}, car(-2), 10, [](int i) { return i < 5; }, {}, left);
}

/// Keeps the codes of a run's reasons.
class Reasons : public ReasonSink {
 public:
  explicit Reasons(std::size_t scans) : codes(scans) {}
  void explain(const std::vector<std::string>& told) override { sentences = told; }
  void accept(std::size_t scan, const std::vector<std::uint8_t>& told) override {
    codes[scan] = told;
  }
  std::vector<std::string> sentences;
  std::vector<std::vector<std::uint8_t>> codes;
};

/// How many points of `owner` have each reason, over all scans, in percent.
std::map<std::string, double> reasons_of(const ConfiguredMethod& method, const World& world,
                                         int owner) {
  Reasons reasons(world.size());
  toy::Masks masks(world.size());
  RunContext context;
  context.reasons = &reasons;
  method.make()->run(world, masks, context);
  std::map<std::string, double> shares;
  int points = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    for (std::size_t k = 0; k < world.owner[i].size(); ++k) {
      if (world.owner[i][k] != owner) continue;
      const std::string& sentence = reasons.sentences.at(reasons.codes[i].at(k));
      const bool removes = sentence.find("saw through") != std::string::npos ||
                           sentence.find("lies in front") != std::string::npos;
      REQUIRE((masks.store.get(i)[k] != 0) == removes);
      shares[sentence.substr(0, 12)] += 1;
      ++points;
    }
  }
  for (auto& [sentence, share] : shares) share *= 100.0 / points;
  return shares;
}

}  // namespace

TEST_CASE("each point's reason fits its answer", "[raymoval]") {
  const World world = box_before_wall();
  ConfiguredMethod method = on_toy_grid("offline");
  CHECK(reasons_of(method, world, kOtherOwner)["a scan saw t"] > 80);
  CHECK(reasons_of(method, world, kWallOwner)["no scan cont"] > 99);
  // Validation gives all back where a cluster needs more points than the box has: at 6 m 1,000
  // times (10 / 6)^2. Without validation all is removed.
  set_parameter(method.configuration, "cluster_points", 1000.0);
  CHECK(reasons_of(method, world, kOtherOwner)["it was a can"] > 95);
  set_parameter(method.configuration, "validate", false);
  CHECK(reasons_of(method, world, kOtherOwner)["a scan saw t"] > 80);
}

TEST_CASE("a point that eq. 11 alone speaks against is not told to have been seen through",
          "[raymoval]") {
  // The wall ends at 0.3 m, so that no return shows that the upper half of the box has left.
  const World world = box_before_wall(0.3);
  auto shares = reasons_of(on_toy_grid("offline"), world, kOtherOwner);
  CHECK(shares["a scan saw t"] > 20);
  CHECK(shares["it lies in f"] > 0.5);
}

namespace {

/// Names of the stages that a run is timed by.
std::set<std::string> stages_of(const ConfiguredMethod& method, int threads) {
  const World world = box_before_wall();
  toy::Masks masks(world.size());
  StageTimes times;
  RunContext context;
  context.threads = threads;
  context.times = &times;
  method.make()->run(world, masks, context);
  std::set<std::string> names;
  for (const StageTimes::Stage& stage : times.stages()) {
    CHECK(stage.seconds > 0.0);
    names.insert(stage.name);
  }
  return names;
}

}  // namespace

TEST_CASE("a run is timed by the steps that it takes", "[raymoval]") {
  using Names = std::set<std::string>;
  const Names steps = {"binning", "raycasting", "classification",
                       "erase",   "validation", "integration"};
  CHECK(stages_of(on_toy_grid("online"), 1) == steps);
  CHECK(stages_of(on_toy_grid("offline"), 1) == steps);
  // What several threads do side by side is one stage.
  const Names side_by_side = stages_of(on_toy_grid("offline"), 2);
  CHECK(side_by_side.count("answer and validation") == 1);
  CHECK(side_by_side.count("validation") == 0);
  // A step that is left out has no time.
  ConfiguredMethod method = on_toy_grid("online");
  set_parameter(method.configuration, "validate", false);
  CHECK(stages_of(method, 1) ==
        Names{"binning", "raycasting", "classification", "erase", "integration"});
}

}  // namespace raymoval::raymoval_test
