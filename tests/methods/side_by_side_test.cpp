// SPDX-License-Identifier: MIT
#include "methods/common/side_by_side.h"

#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

std::vector<std::string> stages_of(int threads) {
  StageTimes times;
  RunContext context;
  context.threads = threads;
  context.times = &times;
  int one = 0, other = 0;
  side_by_side(
      context, "both",
      [&](const RunContext& of_step) {
        const StageScope timed(of_step.times, "one");
        ++one;
      },
      [&](const RunContext& of_step) {
        const StageScope timed(of_step.times, "other");
        ++other;
      });
  CHECK(one == 1);
  CHECK(other == 1);
  std::vector<std::string> names;
  for (const StageTimes::Stage& stage : times.stages()) names.push_back(stage.name);
  return names;
}

}  // namespace

TEST_CASE("two steps are each taken once, and timed apart only if they are apart") {
  CHECK(stages_of(1) == std::vector<std::string>{"one", "other"});
  CHECK(stages_of(2) == std::vector<std::string>{"both"});
}
