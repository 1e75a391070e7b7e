// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_outputs.h"

#include <catch2/catch.hpp>

#include "core/files/file_kind.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/las/las_head.h"
#include "tests/benchmark/clean/recorded_scans.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// One scan of four points on the x axis, seen from (10, 0, 0), with the ring 0 to 3. The last two
/// are removed.
std::shared_ptr<RecordedScans> four_points(const RecordLayout& layout = driver_layout()) {
  std::vector<std::vector<double>> values;
  for (const double x : {0.1, 0.3, 5.0, -150.0}) {
    values.push_back({x, 0, 0, 0.5, static_cast<double>(values.size())});
  }
  return std::make_shared<RecordedScans>(std::vector{records_of(layout, values)},
                                         std::vector{Pose(Eigen::Translation3d(10.0, 0.0, 0.0))});
}
const Mask kTwoRemoved = {0, 0, 1, 1};

/// Writes `paths` of one scan. @return the notes
std::vector<std::string> write(const CleanPaths& paths, const std::shared_ptr<RecordedScans>& scans,
                               const CleanWriting& writing = {}, const Mask& mask = kTwoRemoved) {
  const Sequence sequence = sequence_of(scans);
  CleanOutputs outputs(paths, writing, sequence, no_progress(), kGoOn);
  outputs.add(scans->load(0), mask);
  outputs.commit();
  return outputs.notes();
}

std::vector<double> column(const PointRecords& rows, const std::string& name) {
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.size(); ++i) values.push_back(value_of(rows, i, name));
  return values;
}

}  // namespace

TEST_CASE("Each map has its points, with all fields") {
  const TemporaryFolder folder;
  for (const char* extension : {".pcd", ".ply"}) {
    CleanPaths paths;
    paths.map = folder.path() / ("map" + std::string(extension));
    paths.removed = folder.path() / ("removed" + std::string(extension));
    CHECK(write(paths, four_points()).empty());
    CHECK(column(read_records(paths.map), "ring") == std::vector<double>{0, 1});
    CHECK(column(read_records(paths.removed), "ring") == std::vector<double>{2, 3});
    CHECK(column(read_records(paths.removed), "x")[0] == 15.0);
  }
}

TEST_CASE("What is in no output is in no map") {
  const TemporaryFolder folder;
  CleanPaths paths;
  paths.map = folder.path() / "map.pcd";
  paths.removed = folder.path() / "removed.pcd";
  write(paths, four_points(), {}, {2, 0, 1, 2});
  CHECK(column(read_records(paths.map), "ring") == std::vector<double>{1});
  CHECK(column(read_records(paths.removed), "ring") == std::vector<double>{2});
}

TEST_CASE("A map of nothing is a whole file without points") {
  const TemporaryFolder folder;
  for (const double voxel : {0.0, 0.5}) {
    CleanPaths paths;
    paths.map = folder.path() / "map.pcd";
    CleanWriting writing;
    writing.voxel_size = voxel;
    write(paths, four_points(), writing, {1, 1, 1, 1});
    CHECK(read_records(paths.map).size() == 0);
  }
}

TEST_CASE("Maps of LAS scans keep their scale and reference system") {
  const TemporaryFolder folder;
  const RecordLayout layout = parse_point_layout("x:f8 y:f8 z:f8");
  PointRecords rows = records_of(layout, {{0.125, 0, 0}, {0.25, 0, 0}});
  LasNotes notes;
  notes.scale = Eigen::Vector3d(0.005, 0.005, 1e-7);
  notes.offset.setZero();
  notes.reference_system = "PROJCRS[\"made up\"]";
  rows.las = std::make_shared<LasNotes>(notes);
  const auto scans = std::make_shared<RecordedScans>(
      std::vector{rows}, std::vector{Pose(Eigen::Translation3d(10.0, 0.0, 0.0))});
  for (const char* kind : {"whole", "voxels"}) {
    INFO(kind);
    CleanPaths paths;
    paths.map = folder.path() / (std::string(kind) + ".las");
    CleanWriting writing;
    if (std::string(kind) == "voxels") writing.voxel_size = 0.05;
    write(paths, scans, writing, {0, 0});
    const PointRecords map = read_records(paths.map);
    REQUIRE(map.las != nullptr);
    CHECK(map.las->reference_system == notes.reference_system);
    // A grid of 0.1 um would end 215 m from its offset.
    CHECK(map.las->scale == Eigen::Vector3d(0.005, 0.005, 1e-4));
    CHECK(column(map, "x")[0] == Approx(10.125));
  }
}

TEST_CASE("What a format cannot hold is said, or refused, before anything is written") {
  const TemporaryFolder folder;
  CleanPaths paths;
  paths.map = folder.path() / "map.bin";
  const std::vector<std::string> notes = write(paths, four_points());
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], Contains("-o: ") && Contains(".bin"));
  const auto far =
      std::make_shared<RecordedScans>(std::vector{four_points()->records(0)},
                                      std::vector{Pose(Eigen::Translation3d(691000.0, 0.0, 0.0))});
  paths.map = folder.path() / "far.bin";
  CHECK_THROWS_WITH(write(paths, far), Contains("float32") && Contains(".pcd"));
  CHECK(entries_of(folder.path()).size() == 1);
}
