// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "benchmark/result/speed/speed_record.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

SpeedFigure figure(double yardsticks) {
  return {100.0 * yardsticks, yardsticks, 0.9 * yardsticks, 1.2 * yardsticks};
}

/// A method of 6 yardsticks with 0.5 of loading and 3.5 of scoring: 10 in all.
SpeedRecord ten_yardsticks() {
  SpeedRecord speed{"town:scans=30", 30, 1, 5, "a yardstick 1", 100.0, "a processor", "abc"};
  speed.cells = {{"raymoval:online", figure(10.0), figure(0.5), figure(6.0), figure(3.5)}};
  return speed;
}

}  // namespace

TEST_CASE("A file of times is read as it was written") {
  const test::TemporaryFolder folder;
  write_speed(folder.path() / "speed.json", ten_yardsticks());
  const SpeedRecord read = read_speed(folder.path() / "speed.json");
  CHECK(read.scene == "town:scans=30");
  CHECK((read.scans == 30 && read.threads == 1 && read.repetitions == 5));
  CHECK((read.yardstick == "a yardstick 1" && read.yardstick_milliseconds == 100.0));
  CHECK((read.processor == "a processor" && read.commit == "abc"));
  REQUIRE(read.cells.size() == 1);
  CHECK(read.cells[0].method == "raymoval:online");
  CHECK((read.cells[0].whole.median == 10.0 && read.cells[0].whole.milliseconds == 1000.0));
  CHECK(read.cells[0].load.least == Approx(0.45));
  CHECK(read.cells[0].run.most == Approx(7.2));
  CHECK(read.cells[0].score.median == 3.5);
}

TEST_CASE("A file that holds something else is an error that says what") {
  const test::TemporaryFolder folder;
  folder.write("speed.json", "{");
  CHECK_THROWS_WITH(read_speed(folder.path() / "speed.json"), Contains("this is not JSON"));
  folder.write("speed.json", R"({"schema_version": 1, "scene": 3})");
  CHECK_THROWS_WITH(read_speed(folder.path() / "speed.json"), Contains("scene"));
  folder.write("speed.json", R"({"schema_version": 2})");
  CHECK_THROWS_AS(read_speed(folder.path() / "speed.json"), DataError);
  CHECK_THROWS_AS(read_speed(folder.path() / "none.json"), DataError);
}

TEST_CASE("Up to the band a cell may be slower, and another machine's milliseconds do not count") {
  SpeedRecord run = ten_yardsticks();
  run.yardstick_milliseconds = 900.0;
  run.cells[0].whole = {9000.0, 12.5, 12.0, 13.0};
  CHECK(compare_speed(run, ten_yardsticks(), 1.25).verdict() == ExitCode::kDone);
  const SpeedComparison beyond = compare_speed(run, ten_yardsticks(), 1.24);
  CHECK(beyond.verdict() == ExitCode::kWorse);
  REQUIRE(beyond.worse.size() == 1);
  CHECK_THAT(beyond.worse[0], Contains("raymoval:online: the whole cell takes 1.25 times"));
  CHECK_THAT(speed_text(beyond), Contains("Worse:") && Contains("\nworse.\n"));
}

TEST_CASE("A part of a cell is judged by itself, unless it is short") {
  SpeedRecord run = ten_yardsticks();
  run.cells[0].score = figure(7.0);
  CHECK_THAT(compare_speed(run, ten_yardsticks(), 1.5).worse.at(0), Contains("scoring takes 2.00"));
  // Loading is a twentieth of the cell.
  run = ten_yardsticks();
  run.cells[0].load = figure(1.0);
  CHECK(compare_speed(run, ten_yardsticks(), 1.5).verdict() == ExitCode::kDone);
}

TEST_CASE("What was not measured alike is not comparable") {
  const auto says = [](const SpeedRecord& run, const SpeedRecord& reference) {
    const SpeedComparison comparison = compare_speed(run, reference, 2.0);
    CHECK(comparison.verdict() == ExitCode::kCannotDo);
    return comparison.incomparable.at(0);
  };
  SpeedRecord other = ten_yardsticks();
  other.scene = "town:scans=31";
  CHECK_THAT(says(other, ten_yardsticks()), Contains("the scene is town:scans=31"));
  other = ten_yardsticks();
  other.scans = 29;
  CHECK_THAT(says(other, ten_yardsticks()), Contains("the number of scans is 29"));
  other = ten_yardsticks();
  other.threads = 2;
  CHECK_THAT(says(other, ten_yardsticks()), Contains("the number of threads is 2"));
  other = ten_yardsticks();
  other.yardstick = "a yardstick 2";
  CHECK_THAT(says(other, ten_yardsticks()), Contains("the yardstick is a yardstick 2"));
  other = ten_yardsticks();
  other.cells[0].method = "erasor:general";
  CHECK_THAT(says(other, ten_yardsticks()), Contains("raymoval:online is missing in the run"));
  other = ten_yardsticks();
  other.cells.clear();
  CHECK_THAT(says(ten_yardsticks(), other), Contains("has no cell"));
  other = ten_yardsticks();
  other.cells[0].whole = figure(0.0);
  CHECK_THAT(says(ten_yardsticks(), other), Contains("has no time"));
  // A method more is no reason.
  other = ten_yardsticks();
  other.cells.push_back(other.cells[0]);
  other.cells[1].method = "new";
  const SpeedComparison more = compare_speed(other, ten_yardsticks(), 2.0);
  CHECK(more.verdict() == ExitCode::kDone);
  CHECK_THAT(speed_text(more), Contains("new: not in the reference") && Contains("no regression"));
}
