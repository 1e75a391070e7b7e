// SPDX-License-Identifier: MIT
// Paths that are not UTF-8 are refused before a run writes anything: its record and the messages to
// the processes of methods are JSON, which cannot hold them.
#include <catch2/catch.hpp>

#include "benchmark/run/runner.h"
#include "benchmark/suite/suite_json.h"
#include "core/error.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("A sequence below a path that is not UTF-8 is refused, and a link to it is not") {
  const test::TemporaryFolder folder;
  test::write_drive(folder, "d\xe9/drive");
  const fs::path out = folder.path() / "run";
  CHECK_THROWS_AS(run_suite(test::noop_on(folder / "d\xe9/drive"), {.out = out}), UsageError);
  CHECK_THROWS_WITH(run_suite(test::noop_on(folder / "d\xe9/drive"), {.out = out}),
                    Contains("path of a sequence '" + folder.text() + "/d\xe9/drive'") &&
                        Contains("is not UTF-8") && Contains("make a link"));
  CHECK_FALSE(fs::exists(out));
  fs::create_directory_symlink("d\xe9", folder / "d\xc3\xa9");
  CHECK(run_suite(test::noop_on(folder / "d\xc3\xa9/drive"), {.out = out}).failures.empty());
}

TEST_CASE("Other files that a suite names have paths in UTF-8, too") {
  const test::TemporaryFolder folder;
  Suite suite = test::noop_on(folder / "drive");
  check_paths_fit_json(suite);
  suite.sequences[0].options.poses = "p\xe9.txt";
  CHECK_THROWS_WITH(check_paths_fit_json(suite), Contains("poses of a sequence 'p\xe9.txt'"));
  suite.sequences[0].options.poses = "p\xc3\xa9.txt";
  check_paths_fit_json(suite);
  const fs::path manifest =
      folder.write("m\xe9/manifest.json", R"({"name": "own", "sentence": "Tests.", "version": "1",
                                              "online": true, "command": ["true"]})");
  add_method(suite, "external:" + manifest.string(), "", MethodRegistry::built_in());
  CHECK_THROWS_WITH(check_paths_fit_json(suite), Contains("method 'external:"));
}
