// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/scan_folder.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "benchmark/clean/clean_outputs.h"
#include "core/files/files.h"
#include "datasets/clouds/record_file.h"
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

TEST_CASE("Cleaned scans have the form of the scans: text, compressed, packed") {
  const TemporaryFolder folder;
  const std::string name = GENERATE("a.pcd", "b.pcd", "a.npz", "a.pcd.gz");
  CAPTURE(name);
  const fs::path root = folder.path() / "data";
  fs::create_directories(root);
  PointRecords rows = records_of(
      driver_layout(), {{1, 1, 1, 0.5, 7, 0.25}, {2, 1, 1, 0.5, 8, 0}, {3, 1, 1, 0.5, 9, 0}});
  rows.form.text = name == "a.pcd" || name == "a.pcd.gz";
  rows.form.packed = !rows.form.text;
  rows.form.array = name == "a.npz" ? "arr_0" : "";
  write_atomically(root / name, whole_file(name, rows));
  write_atomically(root / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const fs::path made = cleaned(folder, open_sequence(root.string(), {}));
  const PointRecords left = read_records(made / name);
  REQUIRE(left.size() == 2);
  CHECK(value_of(left, 0, "time") == 0.25);
  CHECK(value_of(left, 1, "ring") == 9.0);
  CHECK(left.form.text == rows.form.text);
  CHECK(left.form.packed == rows.form.packed);
  CHECK(left.form.array == rows.form.array);
  CHECK(open_sequence(made.string(), {}).scans->size() == 1);
}

TEST_CASE("Scans that are in no files are not written one by one") {
  const Sequence street = open_sequence("street", {});
  CHECK_THROWS_WITH(plan_scan_folder(street), Contains("not stored in files"));
}
