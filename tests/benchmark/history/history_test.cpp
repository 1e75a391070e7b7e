// SPDX-License-Identifier: MIT
#include "benchmark/history/history.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "benchmark/history/history_table.h"
#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;

namespace {

/// The method on the street at a day, with `preserved` of 100 static voxels and a time.
HistoryLine line_at(int day, std::int64_t preserved, double yardsticks,
                    const std::string& machine = "desk") {
  HistoryLine line{std::string(40, static_cast<char>('0' + day)),
                   "2026-01-0" + std::to_string(day) + "T00:00:00Z",
                   "1.0.0",
                   machine,
                   "street",
                   "f1",
                   "comb:default",
                   "1",
                   "ok",
                   "digest" + std::to_string(preserved)};
  line.scores.push_back({"erasor",
                         "1",
                         {{"static_voxels", 100}, {"preserved_static", preserved}},
                         {{"PR", static_cast<double>(preserved)}, {"F1", 0.01 * preserved}}});
  line.speed = RecordedSpeed{"kernel 1", 3, 10.0, yardsticks, yardsticks, yardsticks};
  return line;
}

std::vector<std::string> changes(const std::vector<HistoryLine>& lines, double band = 1.3) {
  return history_tracks(lines, band).at(0).events.back().changes;
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("A count that moves by one is a change of the history") {
  CHECK(changes({line_at(1, 90, 1.0), line_at(2, 91, 1.0)}) == Words{"counts of erasor"});
  const auto tracks = history_tracks({line_at(1, 90, 1.0), line_at(2, 91, 1.0)}, 1.3);
  REQUIRE(tracks.size() == 1);
  CHECK(tracks[0].events[0].is_first);
  REQUIRE(tracks[0].events[1].moved.size() == 2);
  CHECK(tracks[0].events[1].moved[0].first == "PR");
  CHECK(tracks[0].events[1].moved[0].second == Approx(1.0));
}

TEST_CASE("A time within the band is no change of the history") {
  CHECK(changes({line_at(1, 90, 1.0), line_at(2, 90, 1.25)}).empty());
  CHECK(changes({line_at(1, 90, 1.0), line_at(2, 90, 1.35)}) == Words{"1.35 times slower"});
  CHECK(changes({line_at(1, 90, 2.0), line_at(2, 90, 1.0)}) == Words{"2.00 times faster"});
  CHECK(changes({line_at(1, 90, 1.0), line_at(2, 90, 1.35)}, 1.5).empty());
}

TEST_CASE("Times whose rounds overlap are no change of the history") {
  HistoryLine busy = line_at(2, 90, 2.0);
  busy.speed->least = 1.0;
  CHECK(changes({line_at(1, 90, 1.0), busy}).empty());
  busy.speed->least = 1.01;
  CHECK(changes({line_at(1, 90, 1.0), busy}) == Words{"2.00 times slower"});
}

TEST_CASE("Times by another fixed kernel are not compared") {
  HistoryLine other = line_at(2, 90, 5.0);
  other.speed->yardstick = "kernel 2";
  CHECK(changes({line_at(1, 90, 1.0), other}).empty());
}

TEST_CASE("A time is compared with the last one that was taken") {
  HistoryLine untimed = line_at(2, 90, 1.0);
  untimed.speed.reset();
  CHECK(changes({line_at(1, 90, 1.0), untimed, line_at(3, 90, 2.0)}) == Words{"2.00 times slower"});
}

TEST_CASE("Versions, scenes, status and masks have words of their own in the history") {
  HistoryLine after = line_at(2, 90, 1.0);
  after.method_version = "2";
  after.masks = "others";
  CHECK(changes({line_at(1, 90, 1.0), after}) ==
        Words{"method version 1 to 2", "masks, with the same counts"});
  after = line_at(2, 90, 1.0);
  after.fingerprint = "f2";
  after.scores[0].version = "2";
  CHECK(changes({line_at(1, 90, 1.0), after}) ==
        Words{"the scene is another", "protocol erasor version 1 to 2"});
  after = line_at(2, 90, 1.0);
  after.status = "failed";
  after.scores.clear();
  after.masks.clear();
  CHECK(changes({line_at(1, 90, 1.0), after}) == Words{"status ok to failed"});
}

TEST_CASE("Machines have tracks of their own in the history") {
  const auto tracks = history_tracks({line_at(1, 90, 1.0), line_at(2, 80, 9.0, "shelf")}, 1.3);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].machine == "desk");
  CHECK(tracks[1].machine == "shelf");
  CHECK(tracks[1].events[0].is_first);
}

TEST_CASE("The history's table has a row for each change, or for each commit") {
  const auto tracks =
      history_tracks({line_at(1, 90, 1.0), line_at(2, 90, 1.0), line_at(3, 95, 1.0)}, 1.3);
  const auto changed = history_tables(tracks, 1.3, false);
  REQUIRE(changed.size() == 1);
  REQUIRE(changed[0].rows.size() == 2);
  CHECK(changed[0].rows[0].cells.back().text == "first");
  CHECK(changed[0].rows[1].label == "333333333");
  CHECK(changed[0].rows[1].cells.back().text == "counts of erasor (F1 +0.0500)");
  CHECK(history_tables(tracks, 1.3, true)[0].rows.size() == 3);
}

TEST_CASE("Lines of a history are read from all files and sorted by date") {
  const test::TemporaryFolder folder;
  const auto text = [](const std::string& date, const std::string& method) {
    return R"({"schema_version":1,"commit":"c","date":")" + date +
           R"(","version":"1","machine":"m","sequence":"s","fingerprint":"f","method":")" + method +
           R"(","method_version":"1","status":"ok","masks":"d","protocols":[],"speed":null})"
           "\n";
  };
  std::ofstream(folder / "b.jsonl") << text("2026-01-02T00:00:00Z", "second");
  std::ofstream(folder / "a.jsonl") << text("2026-01-03T00:00:00Z", "third") << "\n"
                                    << text("2026-01-01T00:00:00Z", "first");
  std::ofstream(folder.path() / "notes.txt") << "no history";
  const std::vector<HistoryLine> lines = read_history(folder.path());
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].method == "first");
  CHECK(lines[1].method == "second");
  CHECK(lines[2].method == "third");
  CHECK_FALSE(lines[0].speed);
}

TEST_CASE("A damaged line of a history is named by file and line") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(read_history(folder.path()), Catch::Contains("holds no history"));
  CHECK_THROWS_WITH(read_history(folder.path() / "gone"), Catch::Contains("no such folder"));
  std::ofstream(folder / "a.jsonl") << "{\"schema_version\":1}\n";
  CHECK_THROWS_WITH(read_history(folder.path()),
                    Catch::Contains("a.jsonl:1: no line of a history"));
  std::ofstream(folder / "a.jsonl") << "\n{\"schema_version\":1,\n";
  CHECK_THROWS_WITH(read_history(folder.path()), Catch::Contains("a.jsonl:2"));
  std::ofstream(folder / "a.jsonl") << "{\"schema_version\":9}\n";
  CHECK_THROWS_WITH(read_history(folder.path()), Catch::Contains("schema version 9"));
  std::ofstream(folder / "results.json") << "{\n}\n";
  CHECK_THROWS_WITH(read_history(folder / "results.json"),
                    Catch::Contains("Expected a file *.jsonl"));
}
