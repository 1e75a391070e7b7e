// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/scan_folder.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "benchmark/clean/clean_outputs.h"
#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "tests/benchmark/clean/recorded_scans.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// A folder of four scans `a.pcd` to `d.pcd` with three points each, whose first coordinates are
/// 1, 2 and 3, and a pose for each at x = 0, 10, 20, 30.
fs::path write_data(const TemporaryFolder& folder) {
  const fs::path root = folder.path() / "data";
  fs::create_directories(root);
  std::string poses;
  for (const char* name : {"a", "b", "c", "d"}) {
    const PointRecords rows = records_of(
        driver_layout(), {{1, 1, 1, 0.5, 7, 0.25}, {2, 1, 1, 0.5, 8, 0}, {3, 1, 1, 0.5, 9, 0}});
    PointRecordWriter file(root / (std::string(name) + ".pcd"));
    file.start(rows.layout);
    file.add(rows);
    file.finish();
    file.commit();
    poses += "1 0 0 " + std::to_string(10 * (name[0] - 'a')) + " 0 1 0 0 0 0 1 0\n";
  }
  write_atomically(root / "poses.txt", poses);
  return root;
}

/// Cleans `sequence` into a folder, with the second point of each scan removed.
fs::path cleaned(const TemporaryFolder& folder, const Sequence& sequence) {
  CleanPaths paths;
  paths.scans = folder.path() / "cleaned";
  CleanOutputs outputs(paths, {}, sequence, no_progress(), kGoOn);
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    outputs.add(sequence.scans->load(i), {0, 1, 0});
  }
  outputs.commit();
  return paths.scans;
}

}  // namespace

TEST_CASE("Cleaned scans open as the sequence did, with every field of the points that are left") {
  const TemporaryFolder folder;
  const fs::path data = write_data(folder);
  const fs::path made = cleaned(folder, open_sequence(data.string(), {}));
  CHECK(read_text(made / "poses.txt") == read_text(data / "poses.txt"));
  const Sequence again = open_sequence(made.string(), {});
  REQUIRE(again.scans->size() == 4);
  CHECK(again.scans->pose(3).translation().x() == 30.0);
  const PointRecords rows = read_records(made / "c.pcd");
  REQUIRE(rows.size() == 2);
  CHECK(value_of(rows, 0, "time") == 0.25);
  CHECK(value_of(rows, 1, "ring") == 9.0);
  CHECK(rows.layout.fields == read_records(data / "c.pcd").layout.fields);
}

TEST_CASE("Some scans of a folder get the poses that are theirs") {
  const TemporaryFolder folder;
  SequenceOptions options;
  options.frames = FrameRange{1, 3, 2};
  const fs::path made = cleaned(folder, open_sequence(write_data(folder).string(), options));
  const Sequence again = open_sequence(made.string(), {});
  REQUIRE(again.scans->size() == 2);
  CHECK(again.scans->load(0).name == "b");
  CHECK(again.scans->pose(0).translation().x() == 10.0);
  CHECK(again.scans->pose(1).translation().x() == 30.0);
}

TEST_CASE("Scans of a recording become .pcd files with a pose file") {
  const TemporaryFolder folder;
  const fs::path bag = fs::path(RAYMOVAL_SOURCE_DIR) / "tests/fuzz/corpus/bag_ros1/rosbag_lz4.bag";
  const Sequence drive = open_sequence(bag.string(), {});
  REQUIRE(drive.scans->size() == 3);
  CleanPaths paths;
  paths.scans = folder.path() / "cleaned";
  CleanOutputs outputs(paths, {}, drive, no_progress(), kGoOn);
  for (std::size_t i = 0; i < 3; ++i) outputs.add(drive.scans->load(i), {0, 1});
  outputs.commit();
  const Sequence again = open_sequence(paths.scans.string(), {});
  REQUIRE(again.scans->size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(again.scans->load(i).name == drive.scans->load(i).name);
    CHECK(again.scans->pose(i).isApprox(drive.scans->pose(i)));
  }
  const PointRecords rows = read_records(paths.scans / "000001.pcd");
  REQUIRE(rows.size() == 1);
  CHECK(value_of(rows, 0, "ring") == 7.0);
  CHECK(rows.layout == drive.records->layout(1));
  CHECK_THROWS_WITH(check_paths({.scans = folder.path() / "cleaned.bag"}),
                    Contains("recordings are not written"));
}
