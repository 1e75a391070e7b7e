// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_paths.h"

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "datasets/clouds/file_source.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/unreadable.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// A folder data/ with a scan and its poses.
struct Data {
  test::TemporaryFolder folder;
  fs::path root = folder.path() / "data";
  Sequence sequence;

  Data() {
    fs::create_directories(root / "scans");
    write_atomically(root / "scans/0.pcd", "a scan");
    write_atomically(root / "poses.txt", "poses");
    sequence.name = "data";
    sequence.input_files = {root / "poses.txt"};
    sequence.opened = sequence.scans = std::make_shared<FileScanSource>(
        std::vector<FrameEntry>{{root / "scans/0.pcd", "", "0", 0.0, Pose::Identity()}},
        FileScanSource::Traits{}, std::nullopt);
  }
};

CleanPaths map_to(const fs::path& path, bool overwrite = true) {
  CleanPaths paths;
  paths.map = path;
  paths.overwrite = overwrite;
  return paths;
}

}  // namespace

TEST_CASE("An input is never an output, whatever its name") {
  const Data data;
  const fs::path hard = data.folder.path() / "hard.pcd", soft = data.folder.path() / "soft.pcd";
  fs::create_hard_link(data.root / "poses.txt", hard);
  fs::create_symlink(data.root / "poses.txt", soft);
  for (const fs::path& path : {hard, soft}) {
    CHECK_THROWS_WITH(check_apart_from(data.sequence, map_to(path)), Contains("read as an input"));
  }
  CHECK_THROWS_WITH(check_apart_from(data.sequence, map_to(data.root / "scans/map.pcd")),
                    Contains("in the folder of the scans"));
  const fs::path given = data.folder.path() / "rule.pcd";
  write_atomically(given, "a rule");
  check_apart_from(data.sequence, map_to(given));
  CHECK_THROWS_WITH(check_apart_from(data.sequence, map_to(given), {given}),
                    Contains("read as an input"));
}

TEST_CASE("A folder around an input is never replaced") {
  const Data data;
  for (const fs::path& path : {data.root, data.root / "scans", data.folder.path()}) {
    CleanPaths paths;
    paths.scans = path;
    paths.overwrite = true;
    CHECK_THROWS_AS(check_apart_from(data.sequence, paths), UsageError);
  }
  CleanPaths beside;
  beside.scans = data.folder.path() / "cleaned";
  check_apart_from(data.sequence, beside);
}

TEST_CASE("What the system cannot look at is not taken for absent") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("map.pcd", "points");
  CHECK(identity_of(file) == identity_of(folder.path() / "." / "map.pcd"));
  CHECK_FALSE(identity_of(folder.path() / "none"));
  CHECK_FALSE(identity_of(file / "below a file"));
  test::make_unreadable(file);
  CHECK_THROWS_AS(identity_of(file), UnreadableError);
  CHECK_THROWS_WITH(identity_of(file), Contains("map.pcd: cannot be accessed ("));
}

TEST_CASE("Only what an earlier run wrote into a folder is replaced") {
  const test::TemporaryFolder folder;
  CleanPaths paths;
  paths.scans = folder.path() / "scans";
  fs::create_directories(paths.scans);
  check_paths(paths);
  write_atomically(paths.scans / "000000.pcd", "points");
  CHECK_THROWS_WITH(check_paths(paths), Contains("--overwrite"));
  paths.overwrite = true;
  CHECK_THROWS_WITH(check_paths(paths), Contains("was not written by"));
  write_atomically(paths.scans / "cleaned.json",
                   R"({"written_by": "raymoval", "files": ["000000.pcd"]})");
  check_paths(paths);
  write_atomically(paths.scans / "notes.txt", "mine");
  CHECK_THROWS_WITH(check_paths(paths), Contains("notes.txt"));
}
