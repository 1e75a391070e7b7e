// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/run_folder.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

Suite one_scan() {
  Suite suite = test::small_suite("0:0");
  add_controls(suite, MethodRegistry::built_in());
  return suite;
}

void write(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << content;
}

/// Every file and folder below `folder` with its content.
std::map<std::string, std::string> all_of(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    all[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? read_text(entry.path()) : "";
  }
  return all;
}

}  // namespace

TEST_CASE("A folder that may be somebody else's is refused, and nothing in it is touched") {
  const std::vector<std::pair<std::string, std::string>> foreign = {
      {"film.mkv.part", "film"},
      {"thesis.part/thesis.tex", "text"},
      {"run.json", R"({"scripts": {"start": "node run.js"}})"},
      {"run.json", R"({"suite": {}, "build": {}, "checksum": "00"})"},
      {"run.lock", "held by the printer"},
      {"cells/notes.txt", "of a microscope"},
      {"table.md", "a table"},
      {"table.md.part", "half a table"},
      {"results.raymoval-0123456789abcdef01234567.part", "not a name that a run gives"},
  };
  for (const auto& [name, content] : foreign) {
    const test::TemporaryFolder folder;
    write(folder.path() / name, content);
    const auto before = all_of(folder.path());
    CHECK_THROWS_WITH(run_suite(one_scan(), {.out = folder.path()}),
                      Contains("Nothing was changed") && Contains(folder.path().string()));
    CHECK(all_of(folder.path()) == before);
  }
}

TEST_CASE("What is not a run's own stays in its folder, whatever its name") {
  const test::TemporaryFolder folder;
  const fs::path out = folder.path() / "run";
  REQUIRE(run_suite(one_scan(), {.out = out, .keep_removals = true}).good());
  const fs::path cell = out / "cells/street/noop-default";
  const std::vector<fs::path> foreign = {out / "film.mkv.part",
                                         out / "thesis.part/thesis.tex",
                                         out / "table.md.77.part",
                                         out / "cells/mine.part",
                                         cell / "mine.part",
                                         cell / "cell.json.part",
                                         new_part_name(out / "thesis.tex"),
                                         new_part_name(cell / "notes.txt")};
  for (const fs::path& file : foreign) write(file, "mine");
  // Remains of killed runs, which only runs name so, are deleted.
  const std::vector<fs::path> left = {new_part_name(out / "results.json"),
                                      new_part_name(cell / "cell.json"),
                                      new_part_name(cell / "removals") / "000000.label"};
  for (const fs::path& file : left) write(file, "half");
  REQUIRE(run_suite(one_scan(), {.out = out, .keep_removals = true}).good());
  for (const fs::path& file : foreign) CHECK(read_text(file) == "mine");
  for (const fs::path& file : left) CHECK_FALSE(fs::exists(file));
  CHECK_FALSE(fs::exists(left.back().parent_path()));
}

TEST_CASE("Removals are not replaced where that would lose a file that no run made") {
  const test::TemporaryFolder folder;
  const fs::path cell = folder.path() / "cells/street/noop-default";
  REQUIRE(run_suite(one_scan(), {.out = folder.path(), .keep_removals = true}).good());
  write(cell / "removals/notes.txt", "mine");
  write_atomically(cell / "cell.json", "damaged, so it is run again");
  CHECK_THROWS_WITH(run_suite(one_scan(), {.out = folder.path(), .keep_removals = true}),
                    Contains("removals: holds files that are not from a run"));
  // What was there is there still, the run's own files as well.
  CHECK(read_text(cell / "removals/notes.txt") == "mine");
  CHECK(fs::exists(cell / "removals/000000.label"));
  CHECK(read_text(cell / "cell.json") == "damaged, so it is run again");
  fs::remove(cell / "removals/notes.txt");
  CHECK(run_suite(one_scan(), {.out = folder.path(), .keep_removals = true}).good());
}

TEST_CASE("Runs without their mark and cells that were copied together are recognised") {
  const test::TemporaryFolder folder;
  const fs::path out = folder.path() / "run";
  REQUIRE(run_suite(one_scan(), {.out = out}).good());
  CHECK(has_file(out / kRunMarker));
  fs::remove(out / kRunMarker);
  CHECK(run_suite(one_scan(), {.out = out}).reused == 3);
  CHECK(has_file(out / kRunMarker));

  const fs::path copied = folder.path() / "copied";
  fs::create_directories(copied);
  fs::copy(out / "cells", copied / "cells", fs::copy_options::recursive);
  write(copied / "run.lock", "process 12 on elsewhere\n");
  CHECK(run_suite(one_scan(), {.out = copied}).reused == 3);
}

TEST_CASE(
    "What a run leaves before it marks its folder is taken for its own, and nothing like it") {
  const auto is_taken = [](const std::vector<std::pair<fs::path, std::string>>& files) {
    const test::TemporaryFolder folder;
    for (const auto& [name, content] : files) write(folder.path() / name, content);
    try {
      prepare_run_folder(folder.path());
    } catch (const UsageError&) {
      CHECK_FALSE(has_file(folder.path() / kRunMarker));
      return false;
    }
    return read_text(folder.path() / kRunMarker).find("raymoval run --out") != std::string::npos;
  };
  CHECK(is_taken({}));
  CHECK(is_taken({{"run.lock", ""}}));
  CHECK(is_taken({{"run.lock", "process 1 on host"}}));
  CHECK_FALSE(is_taken({{"run.lock", "proces"}}));
  CHECK_FALSE(is_taken({{"other.lock", "process 1 on host"}}));
  CHECK_FALSE(is_taken({{"run.lock/file", ""}}));
  for (const char* name :
       {"run.json", "results.json", "results.csv", "table.md", "table.tex", ".raymoval-run"}) {
    CHECK(is_taken({{new_part_name(name), "half"}}));
    CHECK_FALSE(is_taken({{std::string(name) + ".1.part", "half"}}));
  }
  CHECK_FALSE(is_taken({{new_part_name("notes.txt"), "half"}}));
  CHECK(is_taken({{"cells/town/noop/cell.json", "half"}}));
  CHECK_FALSE(is_taken({{"other/town/noop/cell.json", "half"}}));
  CHECK_FALSE(is_taken({{"cells/town/noop/cell.json", "half"}, {"cells/notes.txt", "mine"}}));
  CHECK_FALSE(is_taken({{"cells", "a file"}}));
  CHECK_FALSE(is_taken({{"run.lock", ""}, {"zebra.txt", "mine"}}));
}

TEST_CASE("The lock of a run folder is refused to a second one, by name") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / kLockFile;
  const FolderLock first(file, FolderLock::Mode::kExclusive);
  CHECK_THROWS_WITH(FolderLock(file, FolderLock::Mode::kExclusive),
                    Contains(folder.text() + ": another run is writing there (process ") &&
                        Contains("choose another --out"));
  CHECK_THROWS_WITH(FolderLock(folder.path() / "none" / kLockFile, FolderLock::Mode::kExclusive),
                    Contains("Nothing was changed; choose another --out."));
}
