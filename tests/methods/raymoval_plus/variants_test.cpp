// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "tests/methods/moved_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;

namespace {

ConfiguredMethod variant(const std::string& name) {
  return MethodRegistry::built_in().configure("raymoval_plus:" + name);
}

}  // namespace

TEST_CASE("raymoval_plus takes the movers off a street and leaves the rest") {
  const World world = street(16);
  const MaskStore masks = masks_of(*variant("offline").make(), world);
  // The car drives off ahead: its last places are hidden by itself.
  CHECK(removed_share(world, masks, 3, 0, 15) > 0.7);
  CHECK(removed_share(world, masks, 4, 0, 15) > 0.99);
  for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 15) < 0.001);
  // The person walks past the pole within reach of the vote.
  CHECK(removed_share(world, masks, 2, 0, 15) < 0.1);
}

TEST_CASE("raymoval_plus answers alike with reasons, for any number of threads", "[slow]") {
  struct NoReasons : ReasonSink {
    void explain(const std::vector<std::string>& /*sentences*/) override {}
    void accept(std::size_t /*scan*/, const std::vector<std::uint8_t>& /*codes*/) override {}
  };
  const World world = street(14);
  for (const char* const name : {"offline", "online-map", "online", "online-lag"}) {
    const MaskStore masks = masks_of(*variant(name).make(), world);
    for (const int threads : {1, 3}) {
      Masks others(world.size());
      NoReasons reasons;
      RunContext context;
      context.threads = threads;
      context.reasons = &reasons;
      variant(name).make()->run(world, others, context);
      CHECK(different_verdicts(masks, others.store, world.size()) == 0);
    }
  }
}

TEST_CASE("raymoval_plus online knows nothing of later scans", "[slow]") {
  const ConfiguredMethod method = variant("online");
  const MaskStore all = masks_of(*method.make(), street(12));
  const MaskStore some = masks_of(*method.make(), street(7));
  CHECK(different_verdicts(some, all, 7) == 0);
}

TEST_CASE("raymoval_plus online-lag knows the scans up to its delay, and none after", "[slow]") {
  ConfiguredMethod method = variant("online-lag");
  set_parameter(method.configuration, "delay", 0.3);  // Three scans.
  const World world = street(14);
  const MaskStore all = masks_of(*method.make(), world);
  const MaskStore some = masks_of(*method.make(), street(10));
  CHECK(different_verdicts(some, all, 7) == 0);
  // It does use them: the answer to the last scan but two of the shorter drive was given too early.
  CHECK(different_verdicts(some, all, 10) > 0);
  // More is removed than at once, and with all scans at hand what one pass removes.
  const MaskStore at_once = masks_of(*variant("online").make(), world);
  CHECK(removed_share(world, all, 3, 0, 10) > removed_share(world, at_once, 3, 0, 10));
  for (const int fixed : {0, 1}) CHECK(removed_share(world, all, fixed, 0, 13) < 0.005);
}

TEST_CASE("raymoval_plus online-lag measures heights above the ground that was seen meanwhile") {
  // While the box is stationary, rays hit the ground 1.5 m before it and no nearer, so that its
  // lowest row is the lowest there. Then the sensor comes nearer.
  const Box ground{{-20, -40, -2.5}, {120, 40, -1.5}}, box{{30.3, -1.5, -1.0}, {32, 1.5, 0.6}},
      wall{{45, -40, -1.5}, {46, 40, 8}};
  World world(Scanner{});
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> boxes{ground, wall};
    if (i < 3) boxes.push_back(box);
    world.scan(boxes, Pose(Eigen::Translation3d(0.15 * i, 0, 0)));
  }
  ConfiguredMethod method = variant("online-lag");
  set_parameter(method.configuration, "delay", 0.6);  // Six scans.
  const MaskStore masks = masks_of(*method.make(), world);
  CHECK(removed_share(world, masks, 2, 0, 2) == 1.0);
  for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 11) == 0.0);
}

TEST_CASE("what was taken for ground goes if scans see through it, and the road stays") {
  // Rays hit the ground 1.5 m before the box and beyond it, never below it, so that its lowest row
  // is the lowest there.
  const Box ground{{-20, -40, -2.5}, {120, 40, -1.5}}, box{{30.3, -1.5, -1.0}, {32, 1.5, 0.6}},
      wall{{45, -40, -1.5}, {46, 40, 8}};
  World world(Scanner{});
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> boxes{ground, wall};
    if (i < 3) boxes.push_back(box);
    world.scan(boxes, Pose::Identity());
  }
  for (const bool asks : {true, false}) {
    ConfiguredMethod method = variant("offline");
    set_parameter(method.configuration, "terrain_far_slope", 0.0);
    set_parameter(method.configuration, "ground_evidence", asks);
    const MaskStore masks = masks_of(*method.make(), world);
    const double removed = removed_share(world, masks, 2, 0, 2);
    CHECK((asks ? removed == 1.0 : removed > 0.5 && removed < 1.0));
    for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 11) == 0.0);
  }
}

TEST_CASE("one pass removes nearly what four do", "[slow]") {
  const World world = street(16);
  const MaskStore masks = masks_of(*variant("online-map").make(), world);
  CHECK(removed_share(world, masks, 4, 0, 15) > 0.9);
  for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 15) < 0.005);
}

TEST_CASE("raymoval_plus depends on the lattice of its voxels within bounds", "[slow]") {
  const World world = street(10);
  const std::size_t points = toy::point_count(world);
  const auto changed =
      verdicts_changed_by(whole_motion(0.07, 0.11, 0.05, 0), variant("offline"), world);
  CHECK(static_cast<double>(changed) < 0.02 * static_cast<double>(points));
}

}  // namespace raymoval::raymoval_plus_test
