// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "tests/methods/moved_world.h"

namespace raymoval::raymoval_plus_test {
using namespace toy;

namespace {

constexpr const char* kVariants[] = {"offline", "online-map", "online", "online-lag"};

ConfiguredMethod variant(const std::string& name) {
  return MethodRegistry::built_in().configure("raymoval_plus:" + name);
}

/// A box that stands at 30 m for three of twelve scans. Rays hit the ground 1.5 m before it and
/// beyond it, never below it, so that its lowest row is the lowest there.
World standing_box(double speed) {
  const Box ground{{-20, -40, -2.5}, {120, 40, -1.5}}, box{{30.3, -1.5, -1.0}, {32, 1.5, 0.6}},
      wall{{45, -40, -1.5}, {46, 40, 8}};
  World world(Scanner{});
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> boxes{ground, wall};
    if (i < 3) boxes.push_back(box);
    world.scan(boxes, pose_at(speed * i, 0, 0));
  }
  return world;
}

struct NoReasons : ReasonSink {
  void explain(const std::vector<std::string>& /*sentences*/) override {}
  void accept(std::size_t /*scan*/, const std::vector<std::uint8_t>& /*codes*/) override {}
};
struct NoEvidence : EvidenceSink {
  void accept(std::size_t /*scan*/, std::span<const float> /*evidence*/) override {}
};

}  // namespace

TEST_CASE("raymoval_plus takes the movers off a street and leaves the rest", "[slow]") {
  const World world = street(16);
  for (const char* const name : kVariants) {
    CAPTURE(name);
    const bool is_online = std::string(name) == "online";
    const MaskStore masks = masks_of(*variant(name).make(), world);
    // The car drives off ahead: its last places are hidden by itself.
    CHECK(removed_share(world, masks, 3, 0, 15) > (is_online ? 0.0 : 0.7));
    CHECK(removed_share(world, masks, 4, 0, 15) > (is_online ? 0.5 : 0.9));
    for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 15) < 0.005);
    // The person walks past the pole within reach of the vote.
    CHECK(removed_share(world, masks, 2, 0, 15) < 0.1);
  }
}

TEST_CASE("raymoval_plus answers alike for any number of threads, and who asks for more",
          "[slow]") {
  const World world = street(12);
  for (const char* const name : kVariants) {
    const MaskStore masks = masks_of(*variant(name).make(), world);
    for (const int threads : {1, 2, 8}) {
      Masks others(world.size());
      NoReasons reasons;
      NoEvidence evidence;
      RunContext context;
      context.threads = threads;
      if (threads != 2) context.reasons = &reasons;
      if (threads == 8) context.evidence = &evidence;
      variant(name).make()->run(world, others, context);
      CAPTURE(name, threads);
      CHECK(different_verdicts(masks, others.store, world.size()) == 0);
    }
  }
}

TEST_CASE("raymoval_plus hardly depends on the axes and the origin of the world", "[slow]") {
  const World world = street(10);
  const auto changed = [&](const Pose& motion) {
    return static_cast<double>(verdicts_changed_by(motion, variant("offline"), world)) /
           static_cast<double>(point_count(world));
  };
  // The lattice of the voxels stays, ...
  for (const int quarters : {0, 1, 2}) {
    CHECK(changed(whole_motion(128.0, -64.0, 12.8, quarters)) < 0.001);
  }
  // ... or lies otherwise on things.
  CHECK(changed(whole_motion(0.07, 0.11, 0.05, 0)) < 0.02);
  CHECK(changed(Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()))) < 0.02);
}

// That the order of points changes hardly anything is tested in properties_test.
TEST_CASE("raymoval_plus takes scans without points, one scan alone, and none") {
  for (const char* const name : kVariants) {
    CAPTURE(name);
    const World one = street(1);
    CHECK(masks_of(*variant(name).make(), one).removed_count() == 0);
    CHECK(masks_of(*variant(name).make(), HeldScans(one.sensor())).removed_count() == 0);
    HeldScans empty(one.sensor());
    for (int i = 0; i < 3; ++i) empty.add({});
    CHECK(masks_of(*variant(name).make(), empty).get(2).empty());
    const World some = street(4);
    HeldScans gaps(some.sensor());
    for (std::size_t i = 0; i < 8; ++i) {
      i % 2 == 0 ? gaps.add_scan(some.load(i / 2)) : gaps.add({});
    }
    const MaskStore masks = masks_of(*variant(name).make(), gaps);
    for (std::size_t i = 0; i < 8; ++i) {
      CHECK(masks.get(i).size() == (i % 2 == 0 ? some.owner[i / 2].size() : 0));
    }
  }
}

TEST_CASE("raymoval_plus online knows the scans up to its delay, and none after", "[slow]") {
  const World world = street(12);
  double removed = -1.0;
  for (const std::size_t lag : {0U, 3U}) {  // Scans of a tenth of a second.
    ConfiguredMethod method = variant("online-lag");
    set_parameter(method.configuration, "delay", 0.1 * static_cast<double>(lag));
    const MaskStore all = masks_of(*method.make(), world);
    const MaskStore some = masks_of(*method.make(), street(8));
    CHECK(different_verdicts(some, all, 8 - lag) == 0);
    // It does use them: the last answers were given too early. With them, more is removed.
    CHECK((different_verdicts(some, all, 8) > 0) == (lag > 0));
    CHECK(removed_share(world, all, 3, 0, 8) > removed);
    removed = removed_share(world, all, 3, 0, 8);
  }
}

TEST_CASE("raymoval_plus online-lag measures heights above the ground that was seen meanwhile") {
  const World world = standing_box(0.15);  // The sensor comes nearer, and sees the ground there.
  ConfiguredMethod method = variant("online-lag");
  set_parameter(method.configuration, "delay", 0.6);  // Six scans.
  const MaskStore masks = masks_of(*method.make(), world);
  CHECK(removed_share(world, masks, 2, 0, 2) == 1.0);
  for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 11) == 0.0);
}

TEST_CASE("what was taken for ground goes if scans see through it, and the road stays") {
  const World world = standing_box(0.0);
  const MaskStore masks = masks_of(*variant("offline").make(), world);
  CHECK(removed_share(world, masks, 2, 0, 2) == 1.0);
  for (const int fixed : {0, 1}) CHECK(removed_share(world, masks, fixed, 0, 11) == 0.0);
}

}  // namespace raymoval::raymoval_plus_test
