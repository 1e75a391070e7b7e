// SPDX-License-Identifier: MIT
#include "core/progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <functional>

#include "core/files/files.h"
#include "core/stage_timer.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

/// What `work` prints to standard error.
std::string told_by(const std::function<void()>& work) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "stderr.txt";
  std::fflush(stderr);
  const int before = ::dup(STDERR_FILENO);
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(file, STDERR_FILENO);
  work();
  std::fflush(stderr);
  ::dup2(before, STDERR_FILENO);
  ::close(file);
  ::close(before);
  return read_text(path);
}

std::string told_by_task(ProgressStyle style) {
  return told_by([&] {
    Progress progress(style);
    progress.begin("cleaning", 1000);
    for (int i = 0; i < 1000; ++i) progress.advance();
    progress.say("one cell is done");
    progress.end();
  });
}

}  // namespace

TEST_CASE("In a log a short task is no more than what is said, in plain lines") {
  const std::string log = told_by_task(ProgressStyle::kLog);
  CHECK_THAT(log, Contains("one cell is done\n"));
  CHECK(std::count(log.begin(), log.end(), '\n') <= 2);
  CHECK(log.find_first_of("\r\x1b") == std::string::npos);
}

TEST_CASE("On a terminal one line is rewritten and cleared at the end") {
  const std::string shown = told_by_task(ProgressStyle::kTerminal);
  CHECK_THAT(shown, StartsWith("\r\x1b[Kcleaning: 0 of 1000"));
  CHECK_THAT(shown, Contains("\r\x1b[Kone cell is done\n"));
  CHECK(shown.ends_with("\r\x1b[K"));
  CHECK(std::count(shown.begin(), shown.end(), '\n') == 1);
}

TEST_CASE("A line says what its task is part of") {
  const std::string shown = told_by([] {
    Progress progress(ProgressStyle::kTerminal);
    progress.set_context("[2/3] x on town");
    progress.begin("map", 10);
    progress.set_context("");
    progress.begin("writing", 5);
  });
  CHECK(shown == "\r\x1b[K[2/3] x on town: map: 0 of 10\r\x1b[Kwriting: 0 of 5");
}

TEST_CASE("Progress says how far it is to those who ask, and which task it is") {
  Progress progress;
  CHECK(progress.state() == ProgressState{});
  progress.set_context("[2/3] x on town");
  progress.begin("map", 10);
  progress.advance(4);
  CHECK(progress.state() == ProgressState{"[2/3] x on town", "map", 4, 10, 1});
  progress.begin("map", 10);  // The same name is another task.
  CHECK(progress.state() == ProgressState{"[2/3] x on town", "map", 0, 10, 2});
  progress.end();
  CHECK(progress.state().total == 0);
}

TEST_CASE("Stages add up in the order in which they first ran, scans in their own") {
  StageTimes times;
  times.add("raycasting", 1.0);
  times.add("binning", 0.25);
  times.add("raycasting", 0.5);
  REQUIRE(times.stages().size() == 2);
  CHECK(times.stages()[0].name == "raycasting");
  CHECK(times.stages()[0].seconds == 1.5);
  CHECK(times.stages()[1].seconds == 0.25);
  times.add_scan(7, 1.0);
  times.add_scan(2, 2.0);
  times.add_scan(7, 0.5);  // A second pass over scan 7.
  CHECK(times.seconds_by_scan() == std::vector<double>{2.0, 1.5});
}

TEST_CASE("A scope adds its time once it ends, and does without anyone who asks") {
  StageTimes times;
  {
    const StageScope stage(&times, "binning");
    const ScanScope scan(&times, 3);
    CHECK(times.stages().empty());
  }
  REQUIRE(times.stages().size() == 1);
  CHECK(times.stages()[0].name == "binning");
  CHECK(times.stages()[0].seconds >= 0.0);
  CHECK(times.seconds_by_scan().size() == 1);
  const StageScope nobody(nullptr, "binning");
  const ScanScope no_scan(nullptr, 0);
}
