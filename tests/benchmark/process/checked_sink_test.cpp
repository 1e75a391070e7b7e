// SPDX-License-Identifier: MIT
#include "benchmark/process/checked_sink.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("The sink holds a method to one mask of the right size per scan") {
  const test::TwoScans world;
  const TimedSource scans(world);
  CheckedSink sink("mine", scans, MaskStore(2));

  CHECK_THROWS_AS(sink.accept(2, {1}), MethodError);
  CHECK_THROWS_WITH(sink.accept(0, {1, 0}), Contains("scan 0") && Contains("2 values"));
  CHECK_THROWS_AS(sink.accept(0, {1, 0, 2}), MethodError);

  sink.accept(0, {1, 0, 1});
  CHECK_THROWS_WITH(sink.accept(0, {1, 0, 1}), Contains("second time"));
  CHECK_THROWS_WITH(sink.finish(), Contains("no mask for scan 1"));

  sink.accept(1, {0});
  const MaskStore masks = sink.finish();
  CHECK(masks.get(0) == Mask{1, 0, 1});
  CHECK(masks.removed_count() == 2);
}

namespace {

/// A scan with one point every tenth of a second.
class TenHertz : public toy::HeldScans {
 public:
  TenHertz() {
    for (int i = 0; i < 20; ++i) add({{1, 0, 0}});
  }
};

/// What became of an answer for scan 0 after all scans up to `last` were read; empty if it is
/// accepted.
std::string fault_of_answer(double delay_s, int threads, std::size_t last) {
  const TenHertz world;
  const TimedSource scans(world, OnlineRule{"mine", delay_s, threads});
  CheckedSink sink("mine", scans, MaskStore(20));
  for (std::size_t scan = 0; scan <= last; ++scan) (void)scans.load(scan);
  try {
    sink.accept(0, {1});
  } catch (const MethodError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("An online method reads each scan once") {
  const test::TwoScans world;
  const TimedSource online(world, OnlineRule{"mine", 0.0, 1});
  (void)online.load(0);
  (void)online.load(1);
  CHECK_THROWS_WITH(online.load(0), Contains("'mine'") && Contains("scan 0 a second time"));
  const TimedSource offline(world);
  (void)offline.load(0);
  CHECK(offline.load(0).size() == 3);
}

TEST_CASE("An online method answers before it reads on, or within its delay") {
  CHECK(fault_of_answer(0.0, 1, 0).empty());
  CHECK_THAT(fault_of_answer(0.0, 1, 1), Contains("answers for scan 0 after it has read scan 1"));
  // Four threads prepare four scans while they take in the four before.
  CHECK(fault_of_answer(0.0, 4, 7).empty());
  CHECK_THAT(fault_of_answer(0.0, 4, 8), Contains("after it has read scan 8"));
  // Half a second later it has scans 0 to 5, and scan 6 shows that the time has passed.
  CHECK(fault_of_answer(0.5, 1, 6).empty());
  CHECK_THAT(fault_of_answer(0.5, 1, 7), Contains("and those of the 0.5 s after it"));
}

TEST_CASE("Evidence becomes a confidence in steps of 1/250, once per scan and point") {
  const test::TwoScans world;  // Three points, then one.
  const TimedSource scans(world);
  const Calibration calibration{"", {{0.0F, 0.1F}, {1.0F, 0.9F}}};
  CheckedConfidence sink("mine", calibration, scans, ScanSpool(2));
  const auto give = [&](std::size_t scan, const std::vector<float>& evidence) {
    sink.accept(scan, evidence);
  };

  CHECK_THROWS_WITH(give(2, {1}), Contains("only 2 scans"));
  CHECK_THROWS_WITH(give(0, {1, 0}), Contains("scan 0") && Contains("2 values"));
  CHECK_THROWS_WITH(give(0, {1, 0, 1.5F}), Contains("not from 0 to 1"));
  CHECK_THROWS_WITH(give(0, {1, 0, std::numeric_limits<float>::quiet_NaN()}),
                    Contains("not from 0 to 1"));

  give(0, {0, 0.5F, 1});
  CHECK_THROWS_WITH(give(0, {0, 0.5F, 1}), Contains("second time"));
  CHECK_THROWS_WITH(sink.finish(), Contains("no evidence for scan 1"));
  give(1, {0});
  const ConfidenceStore kept = sink.finish();
  CHECK(kept.steps.get(0) == std::string({25, 125, static_cast<char>(225)}));  // 25: 0.1.
  CHECK(kept.steps.get(1) == std::string({25}));
  CHECK(confidence_of_steps(225) == 0.9F);
}

TEST_CASE("The digest tells masks apart, also where only the scans' borders differ") {
  const auto digest = [](const std::vector<Mask>& masks) {
    MaskStore store(masks.size());
    for (std::size_t i = 0; i < masks.size(); ++i) store.set(i, masks[i]);
    return mask_digest(store);
  };
  CHECK(digest({{1, 0}, {0}}) == digest({{1, 0}, {0}}));
  CHECK(digest({{1, 0}, {0}}) != digest({{1}, {0, 0}}));
  CHECK(digest({{1, 0}, {0}}) != digest({{0, 1}, {0}}));
}
