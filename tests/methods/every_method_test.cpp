// SPDX-License-Identifier: MIT
// The contract of every method.
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <span>
#include <vector>

#include "core/scan/reach.h"
#include "tests/methods/moved_world.h"

using namespace raymoval;

namespace {

/// Every variant that this build has of every method but the controls, and peopleremover with a
/// window of scans.
std::vector<ConfiguredMethod> all_methods() {
  std::vector<ConfiguredMethod> methods;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->parameters.empty()) continue;
    for (const MethodVariant& variant : entry->variants) {
      if (!variant.is_available) continue;
      methods.push_back(MethodRegistry::built_in().configure(entry->name + ":" + variant.name));
      toy::coarsen_octomap(methods.back());
      if (entry->name != "peopleremover") continue;
      methods.push_back(methods.back());
      set_parameter(methods.back().configuration, "diff", std::int64_t{1});
    }
  }
  return methods;
}

/// Keeps the evidence of a run.
class KeptEvidence : public EvidenceSink {
 public:
  explicit KeptEvidence(std::size_t scans) : by_scan(scans) {}
  void accept(std::size_t scan, std::span<const float> evidence) override {
    by_scan[scan].assign(evidence.begin(), evidence.end());
  }
  std::vector<std::vector<float>> by_scan;
};

/// A street, of which only the third of the points ahead of the sensor is kept; both movers are
/// there. hmm_mos removes nothing from these, and gets all points.
const toy::World& street_for(const ConfiguredMethod& method) {
  static const toy::World around = toy::street(10), ahead = [] {
    toy::Scanner scanner;
    scanner.azimuth_from = -60.0;
    scanner.azimuth_to = 60.0;
    return toy::street(10, 7, scanner);
  }();
  return method.entry->name == "hmm_mos" ? around : ahead;
}

}  // namespace

TEST_CASE("any number of threads gives the same answer", "[threads][slow]") {
  // As many threads as requested, on any number of processors.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  for (const ConfiguredMethod& method : all_methods()) {
    INFO(method.full_name());
    const toy::World& world = street_for(method);
    const MaskStore one = masks_of(*method.make(), world, 1);
    CHECK(one.removed_count() > 0);
    for (const int threads : {2, 8}) {
      INFO(threads << " threads");
      const MaskStore many = masks_of(*method.make(), world, threads);
      CHECK(toy::different_verdicts(one, many, world.size()) == 0);
    }
  }
}

// Requesting evidence does not change the result.
TEST_CASE("evidence changes no mask, and is the same for any number of threads",
          "[threads][slow]") {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  for (const ConfiguredMethod& method : all_methods()) {
    if (method.entry->confidence.empty()) continue;
    INFO(method.full_name());
    const toy::World& world = street_for(method);
    const MaskStore unasked = masks_of(*method.make(), world);
    std::vector<std::vector<float>> one;
    for (const int threads : {1, 8}) {
      INFO(threads << " threads");
      toy::Masks masks(world.size());
      KeptEvidence kept(world.size());
      RunContext context;
      context.threads = threads;
      context.evidence = &kept;
      method.make()->run(world, masks, context);
      CHECK(toy::different_verdicts(unasked, masks.store, world.size()) == 0);
      if (threads == 1) one = kept.by_scan;
      CHECK(kept.by_scan == one);
    }
    for (std::size_t i = 0; i < world.size(); ++i) CHECK(one[i].size() == world.load(i).size());
  }
}

TEST_CASE("no scans, empty scans and lone points") {
  toy::HeldScans scans;
  scans.add({});
  scans.add({{3.0F, 2.0F, 1.0F}});
  scans.add({});
  scans.add({{0.0F, 0.0F, 0.0F}});  // In the sensor itself.
  for (const ConfiguredMethod& method : all_methods()) {
    INFO(method.full_name());
    CHECK(masks_of(*method.make(), toy::HeldScans(), 2).size() == 0);
    const MaskStore masks = masks_of(*method.make(), scans, 2);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      REQUIRE(masks.has(i));
      CHECK(masks.get(i) == Mask(scans.load(i).size(), 0));
    }
  }
}

TEST_CASE("points next to a sensor that stands on walls of voxels end every walk") {
  toy::HeldScans scans;
  std::vector<Eigen::Vector3f> points;
  for (const float length : {1e-45F, 1e-38F, 1e-27F, 1e-23F, 1e-19F, 1e-12F, 1e-6F, 0.2F}) {
    for (int signs = 0; signs < 27; ++signs) {
      points.emplace_back(Eigen::Vector3f(static_cast<float>(signs % 3 - 1),
                                          static_cast<float>(signs / 3 % 3 - 1),
                                          static_cast<float>(signs / 9 - 1)) *
                          length);
    }
  }
  scans.add(points);
  scans.add(points, Pose(Eigen::Translation3d(0.0, 0.0, 3.2)));
  for (const ConfiguredMethod& method : all_methods()) {
    INFO(method.full_name());
    const MaskStore masks = masks_of(*method.make(), scans, 2);
    for (std::size_t i = 0; i < scans.size(); ++i) CHECK(masks.has(i));
  }
}

// What inspection lets pass must not make a method fail.
TEST_CASE("every method takes scans and points as far away as inspection does", "[slow]") {
  constexpr double kFar = kUsualReach - kFarthestReturn - 1.0;
  const auto far = static_cast<float>(kFarthestReturn);
  toy::HeldScans scans;
  scans.add({{far, 0.0F, 0.0F}, {0.0F, 0.0F, -far}, {3.0F, 2.0F, 1.0F}});
  scans.add({{0.0F, far, 0.0F}, {0.0F, 0.0F, -far}, {0.3F, 0.2F, 0.1F}},
            Pose(Eigen::Translation3d(0.0, kFar, -kFar)));
  for (const ConfiguredMethod& method : all_methods()) {
    INFO(method.full_name());
    const MaskStore masks = masks_of(*method.make(), scans, 2);
    for (std::size_t i = 0; i < scans.size(); ++i) CHECK(masks.has(i));
  }
}

TEST_CASE("a cancelled run stops") {
  const toy::World world = toy::street(2);
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  std::vector<ConfiguredMethod> methods = all_methods();
  methods.push_back(MethodRegistry::built_in().configure("noop"));
  for (const ConfiguredMethod& method : methods) {
    INFO(method.full_name());
    toy::Masks masks(world.size());
    CHECK_THROWS_AS(method.make()->run(world, masks, context), Cancelled);
    CHECK_FALSE(masks.store.has(0));
  }
}
