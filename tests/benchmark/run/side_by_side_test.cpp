// SPDX-License-Identifier: MIT
#include "benchmark/run/sequence_run.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Street's first scans with a method, by two protocols.
Suite small_suite(const char* frames) {
  Suite suite;
  for (const char* name : {"first", "second"}) {
    SequenceOptions options;
    options.frames = parse_frame_range(frames);
    options.name = name;
    suite.sequences.push_back({"street", options});
  }
  add_method(suite, "raymoval:online", "", MethodRegistry::built_in());
  add_protocol(suite, "erasor", "");
  add_protocol(suite, "dynamicmap", "");
  add_controls(suite, MethodRegistry::built_in());
  return suite;
}

std::vector<Cell> results_in(const std::filesystem::path& out) {
  return read_results(out / "results.json").cells;
}

}  // namespace

TEST_CASE("All is done once, and two at once") {
  std::atomic<int> at_once = 0;
  std::atomic<bool> met = false;
  std::mutex mutex;
  std::multiset<std::size_t> done;
  run_side_by_side(2, 5, [&](std::size_t i) {
    ++at_once;
    // The first two wait for each other. If they were not at work at once, this would not end.
    while (i < 2 && !met) met = met || at_once >= 2;
    const std::lock_guard lock(mutex);
    done.insert(i);
  });
  CHECK(done == std::multiset<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("After an error nothing more is begun, and the error of the lowest is thrown") {
  std::atomic<int> begun = 0;
  const auto fail_late = [&](std::size_t i) {
    ++begun;
    // Both fail, number 1 first.
    while (i == 0 && begun < 2) std::this_thread::yield();
    if (i < 2) throw std::runtime_error(std::to_string(i));
  };
  CHECK_THROWS_WITH(run_side_by_side(2, 100, fail_late), "0");
  CHECK(begun == 2);
}

TEST_CASE("Cells that run at once have the same results in the same order, and marked times") {
  const test::TemporaryFolder folder;
  const auto alone = folder.path() / "alone", beside = folder.path() / "beside";
  const Suite suite = small_suite("0:1");
  CHECK(run_suite(suite, {.out = alone}).good());
  const RunSummary summary = run_suite(suite, {.out = beside, .jobs = 3});
  CHECK(summary.good());
  CHECK(summary.cells == 8);
  std::vector<Cell> expected = results_in(alone), found = results_in(beside);
  REQUIRE(found.size() == 8);
  REQUIRE(expected.size() == 8);
  for (std::size_t i = 0; i < found.size(); ++i) {
    REQUIRE(found[i].measured);
    CHECK(found[i].measured->side_by_side == 3);
    CHECK(found[i].measured->threads == 1);
    CHECK_FALSE(expected[i].measured->side_by_side);
    found[i].measured.reset();
    expected[i].measured.reset();
    CHECK(json_text(to_json(found[i])) == json_text(to_json(expected[i])));
  }
  CHECK(read_run_record(beside / "run.json").machine->jobs == 3);
  CHECK_FALSE(read_run_record(alone / "run.json").machine->jobs);
}

TEST_CASE("A run with jobs goes on where one without has stopped, and the other way round") {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "run";
  RunOptions first{.out = out};
  first.only = {"first/*"};
  CHECK(run_suite(small_suite("0:0"), first).cells == 4);
  const RunSummary second = run_suite(small_suite("0:0"), {.out = out, .jobs = 2});
  CHECK(second.reused == 4);
  CHECK(second.cells == 8);
  const std::vector<Cell> cells = results_in(out);
  CHECK_FALSE(cells.front().measured->side_by_side);
  CHECK(cells.back().measured->side_by_side == 2);
  CHECK(run_suite(small_suite("0:0"), {.out = out}).reused == 8);
}

TEST_CASE("A sequence that cannot be read is failed cells, and the other one is run") {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "run";
  Suite suite = small_suite("0:0");
  const std::string row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  // An infinite point, which shows when the scan is read.
  folder.write("broken/velodyne/000000.bin",
               std::string("\0\0\x80\x7F", 4) + std::string(12, '\0'));
  folder.write("broken/labels/000000.label", std::string(4, '\0'));
  folder.write("broken/poses.txt", row);
  folder.write("broken/sequence.json",
               R"({"poses_are_lidar": true, "sensor": "hdl64e", "up": "z"})");
  suite.sequences[0] = {(folder.path() / "broken").string(), {}};
  suite.sequences[0].options.name = "first";
  const RunSummary summary = run_suite(suite, {.out = out, .jobs = 2});
  CHECK(summary.cells == 8);
  REQUIRE(summary.failures.size() == 4);
  CHECK_THAT(summary.failures[0], Contains("000000.bin"));
}

TEST_CASE("A cancelled run with jobs says so and keeps what was finished") {
  const test::TemporaryFolder folder;
  const std::atomic<bool> cancel = true;
  RunOptions options{.out = folder.path() / "run"};
  options.cancel = &cancel;
  options.jobs = 2;
  CHECK_THROWS_AS(run_suite(small_suite("0:0"), options), Cancelled);
}
