// SPDX-License-Identifier: MIT
#include "tests/methods/dynablox/oracle.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/simd/instruction_set_scope.h"
#include "methods/dynablox/dynablox.h"
#include "tests/methods/moved_world.h"

namespace raymoval::dynablox_test {

namespace {

/// Coarse and near, so that a record for every voxel is no burden.
Parameters coarse() {
  Parameters parameters;
  parameters.voxel_size = 0.3;
  parameters.truncation = 0.6;
  parameters.occupied_below = 0.45;
  parameters.separation = 0.3;
  parameters.burn_in = 2;
  parameters.min_points = 5;
  parameters.max_range = 7.0;
  return parameters;
}

/// A room through which two people walk, before a sensor that turns and tilts.
toy::World room(int scans, unsigned seed) {
  std::mt19937 random(seed);
  const auto some = [&random](double most) {
    return most * static_cast<double>(random() % 1000) / 1000.0;
  };
  toy::Scanner scanner;
  scanner.azimuth_from = -50.0;
  scanner.azimuth_to = 50.0;
  toy::World world{scanner};
  std::vector<toy::Box> fixed{{{-4, -8, -1.8}, {8, 8, -1.02 - some(0.2)}},
                              {{6.1 + some(0.5), -8, -1.8}, {8, 8, 3}},
                              {{2.0 + some(1.0), 1.5 + some(0.5), -1.2}, {4.1, 2.4, some(0.5)}}};
  for (int i = 0; i < scans; ++i) {
    std::vector<toy::Box> boxes = fixed;
    const double y = -1.5 + 0.45 * i + some(0.1), x = 5.2 - 0.31 * i + some(0.1);
    boxes.push_back({{4.1, y, -1.2}, {4.5, y + 0.5, 0.6}});
    boxes.push_back({{x, -1.9, -1.2}, {x + 0.5, -1.4, 0.6}});
    Pose pose(Eigen::Translation3d(0.2 * i + some(0.1), some(0.2), some(0.1)));
    pose.rotate(Eigen::AngleAxisd(some(0.2) - 0.1, Eigen::Vector3d::UnitZ()));
    pose.rotate(Eigen::AngleAxisd(some(0.1) - 0.05, Eigen::Vector3d::UnitY()));
    world.scan(boxes, pose);
  }
  return world;
}

/// Sets of parameters.
std::vector<Parameters> many_parameters() {
  std::vector<Parameters> many(5, coarse());
  many[1].offline = true;
  many[2].separation = 0.9;
  many[3].frames_to_reset = 2;
  many[3].separation = 0.1;
  many[4].max_weight = 2;
  return many;
}

}  // namespace

TEST_CASE("dynablox: the fast way gives what the description says") {
  const std::vector<Parameters> many = many_parameters();
  for (std::size_t variant = 0; variant < many.size(); ++variant) {
    INFO("variant " << variant);
    const toy::World scans = room(8, 3 + static_cast<unsigned>(variant));
    Oracle oracle(many[variant], scans.sensor());
    const std::vector<Mask> expected = oracle.masks(scans);
    CHECK(oracle.ever_free_count() > 100);
    const MaskStore masks = toy::masks_of(*make_dynablox(many[variant]), scans, 2);
    for (std::size_t i = 0; i < scans.size(); ++i) CHECK(masks.get(i) == expected[i]);
    CHECK(masks.removed_count() > 20);
  }
}

TEST_CASE("dynablox: all instruction sets give the same", "[simd]") {
  const toy::World scans = room(8, 5);
  Parameters parameters = coarse();
  parameters.offline = true;
  const MaskStore best = toy::masks_of(*make_dynablox(parameters), scans);
  CHECK(best.removed_count() > 20);
  for (const InstructionSet set : supported_instruction_sets()) {
    INFO(instruction_set_name(set));
    const InstructionSetScope scope(set);
    const MaskStore masks = toy::masks_of(*make_dynablox(parameters), scans);
    CHECK(toy::different_verdicts(best, masks, scans.size()) == 0);
  }
}

}  // namespace raymoval::dynablox_test
