// SPDX-License-Identifier: MIT
// Stored results of a sequence whose data cannot be read any more.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "core/files/files.h"
#include "datasets/simulation/scene/simulated.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A drive of three scans in a folder.
struct Drive {
  test::TemporaryFolder folder;
  fs::path data = folder.path() / "drive";

  Drive() {
    SimulationOptions options;
    options.scene = "town";
    options.sensor = "vlp16";
    options.scans = 3;
    write_simulated(options, data, 2, nullptr);
  }
};

/// That drive with a method that removes nothing, and a sequence that can always be read.
Suite beside_street(const fs::path& drive) {
  Suite suite = test::noop_on("street");
  suite.sequences.insert(suite.sequences.begin(), {drive.string(), {}});
  return suite;
}

}  // namespace

TEST_CASE("A stored result stays where its data cannot be read any more") {
  const Drive drive;
  const fs::path out = drive.folder.path() / "run", labels = drive.data / "labels/000001.label";
  const fs::path cell = out / "cells/town/noop-default";
  const Suite suite = beside_street(drive.data);
  REQUIRE(run_suite(suite, {.out = out, .keep_removals = true}).good());
  const std::string stored = read_text(cell / "cell.json"), whole = read_text(labels);
  write_atomically(labels, whole.substr(0, whole.size() - 1));
  for (const bool collect : {true, false}) {
    const RunSummary summary =
        run_suite(suite, {.out = out, .keep_removals = true, .collect = collect});
    REQUIRE(summary.failures.size() == 1);
    CHECK_THAT(summary.failures[0], Contains("000001.label"));
    CHECK_THAT(read_text(out / "results.csv"), Contains("town,noop,default,erasor,bad_data,"));
    CHECK(read_text(cell / "cell.json") == stored);
    CHECK(fs::exists(cell / "removals/000001.label"));
  }
  write_atomically(labels, whole);
  CHECK(run_suite(suite, {.out = out, .keep_removals = true}).reused == 2);
}

TEST_CASE("A sequence that was never read has cells that say so, but not if nothing is to be run") {
  const Drive drive;
  const fs::path out = drive.folder.path() / "run";
  const Suite suite = beside_street(drive.data);
  write_atomically(drive.data / "labels/000001.label", "x");
  const fs::path cell = out / "cells/town/noop-default/cell.json";
  CHECK_FALSE(run_suite(suite, {.out = out, .collect = true}).good());
  CHECK_FALSE(fs::exists(cell));
  CHECK_FALSE(run_suite(suite, {.out = out}).good());
  CHECK(read_sealed(cell)["status"] == "bad_data");
}
