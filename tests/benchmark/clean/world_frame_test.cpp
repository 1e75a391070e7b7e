// SPDX-License-Identifier: MIT
// What the world's origin and axes must not change: verdicts, counts, and the digits of maps.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "benchmark/clean/clean_outputs.h"
#include "benchmark/clean/cleaned_cloud.h"
#include "benchmark/process/method_run.h"
#include "benchmark/run/scored_sequence.h"
#include "core/scan/local_frame.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "datasets/world_axes/up_direction.h"
#include "tests/benchmark/small_world.h"
#include "tests/methods/moved_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// The street with its world moved; labels and points are those of the street.
struct MovedStreet {
  Sequence street, moved;
  std::shared_ptr<const LocalFrameSource> scans;

  explicit MovedStreet(const Pose& motion, long step = 3) {
    SequenceOptions options;
    options.frames = FrameRange{0, 27, step};
    street = moved = open_sequence("street", options);
    scans = std::make_shared<const LocalFrameSource>(*street.scans, motion);
    moved.opened = moved.scans = scans;
    moved.up_choice = std::make_shared<UpChoice>(std::nullopt);
  }
};

Pose shifted(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

MaskStore masks_on(const Sequence& sequence, const MethodRequest& request) {
  const MethodAnswer answer = run_method({&sequence, &request, {2}});
  INFO(answer.reason);
  REQUIRE(answer.status == CellStatus::kOk);
  return answer.masks;
}

std::size_t points_of(const MaskStore& masks) {
  std::size_t count = 0;
  for (std::size_t scan = 0; scan < masks.size(); ++scan) count += masks.point_count(scan);
  return count;
}

std::vector<MethodRequest> all_methods() {
  std::vector<MethodRequest> requests;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    for (const MethodVariant& variant : entry->variants) {
      if (!variant.is_available) continue;
      auto method = MethodRegistry::built_in().configure(entry->name + ":" + variant.name);
      toy::coarsen_octomap(method);
      requests.push_back({method.full_name(), method});
    }
  }
  return requests;
}

ProtocolResult scored(const Sequence& sequence, const std::string& protocol,
                      const MaskStore& masks) {
  ScoredSequence scored(sequence, {{protocol, protocol, protocol_defaults(protocol)}}, 2, nullptr);
  return scored.score(masks).protocols.front();
}

}  // namespace

TEST_CASE("no method is changed by a shift of the world, or an exchange of its axes",
          "[frames][slow]") {
  constexpr long kStep = 6;  // Each of all methods runs four times.
  // A shift that double precision holds exactly beside the street's poses, and one it does not.
  const MovedStreet utm(shifted(691000.25, 5336000.5, 512.0), kStep);
  const MovedStreet odd(
      shifted(1e5 * std::sqrt(47.0), 1e6 * std::acos(-1.0), -100.0 * std::sqrt(2.0)), kStep);
  Pose y_down = Pose::Identity();
  y_down.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const MovedStreet turned(y_down, kStep);
  REQUIRE(axis_text(turned.moved.up().direction) == "-y");
  for (const MethodRequest& request : all_methods()) {
    INFO(request.name);
    const MaskStore here = masks_on(utm.street, request);
    CHECK(toy::different_verdicts(here, masks_on(utm.moved, request), here.size()) == 0);
    // Rounding of 1e-9 m may put single points into the neighbouring voxel.
    CHECK(toy::different_verdicts(here, masks_on(odd.moved, request), here.size()) <=
          points_of(here) / 10000);
    // The lattice is the same, except for rotations by 90 degrees about z.
    CHECK(toy::different_verdicts(here, masks_on(turned.moved, request), here.size()) <=
          points_of(here) / 1000);
  }
}

TEST_CASE("counts are the same from every whole kilometre", "[frames][slow]") {
  const MethodRequest method{"raymoval_plus:offline",
                             MethodRegistry::built_in().configure("raymoval_plus:offline")};
  const MovedStreet near(shifted(3000.0, -2000.0, 1000.0));
  const MovedStreet far(shifted(691000.0, 5336000.0, 1000.0));
  const MaskStore masks = masks_on(near.street, method);
  for (const char* protocol : {"erasor", "dynamicmap", "dynamicmap-strict"}) {
    INFO(protocol);
    const ProtocolResult here = scored(near.street, protocol, masks);
    CHECK(scored(near.moved, protocol, masks).counts == here.counts);
    CHECK(scored(far.moved, protocol, masks).counts == here.counts);
  }
}

TEST_CASE("a cleaned map far from the origin is scored as near it", "[frames][slow]") {
  const MovedStreet far(shifted(691000.0, 5336000.0, 1000.0));
  const auto counts = [](const Sequence& sequence) {
    ProtocolRequest erasor{"erasor", "erasor", protocol_defaults("erasor")};
    set_parameter(erasor.options, "label_mode", std::string("nearest"));
    set_parameter(erasor.options, "lift", 0.0);
    ScoredSequence scored(sequence, {erasor}, 2, nullptr);
    const CleanedCloud oracle = oracle_cloud(sequence, 0.0, nullptr);
    return scored.score_cloud(0, CloudEstimate(oracle.points)).counts;
  };
  CHECK(counts(far.moved) == counts(far.street));
}

TEST_CASE("a map far from the origin keeps its millimetres", "[frames]") {
  const test::TemporaryFolder folder;
  const Eigen::Vector3d shift(691000.25, 5336000.5, 512.0);
  const MovedStreet far{Pose(Eigen::Translation3d(shift))};
  CHECK(map_precision(*far.scans).coordinates == Coordinates::kDouble);
  CHECK(map_precision(*far.street.scans).coordinates == Coordinates::kFloat);
  for (const char* name : {"map.pcd", "map.ply"}) {
    for (const double voxel : {0.0, 0.1}) {
      INFO(name << " voxel " << voxel);
      const auto written = [&](const Sequence& of, const Eigen::Vector3d& from) {
        Progress progress(ProgressStyle::kQuiet);
        const std::atomic<bool> cancel{false};
        CleanPaths paths;
        paths.map = folder.path() / name;
        CleanWriting writing;
        writing.voxel_size = voxel;
        CleanOutputs outputs(paths, writing, of, progress, cancel);
        const Scan scan = of.scans->load(4);
        outputs.add(scan, Mask(scan.size(), 0));
        outputs.commit();
        return read_cloud(paths.map, from).points;
      };
      const auto here = written(far.street, Eigen::Vector3d::Zero());
      const auto there = written(far.moved, shift);
      REQUIRE(there.size() == (voxel > 0.0 ? there.size() : here.size()));
      REQUIRE(there.size() > 1000);
      if (voxel > 0.0) continue;  // Another lattice: 0.25 m is no whole number of 0.1 m.
      double worst = 0.0;
      for (std::size_t i = 0; i < here.size(); ++i) {
        worst = std::max(worst, static_cast<double>((here[i] - there[i]).norm()));
      }
      CHECK(worst < 0.0001);
    }
  }
}
