// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_outputs.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
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
    paths.labelled = folder.path() / ("labelled" + std::string(extension));
    CHECK(write(paths, four_points()).empty());
    CHECK(column(read_records(paths.map), "ring") == std::vector<double>{0, 1});
    CHECK(column(read_records(paths.removed), "ring") == std::vector<double>{2, 3});
    const PointRecords labelled = read_records(paths.labelled);
    CHECK(column(labelled, "ring") == std::vector<double>{0, 1, 2, 3});
    CHECK(column(labelled, "label") == std::vector<double>{9, 9, 251, 251});
    CHECK(column(labelled, "x")[2] == 15.0);
  }
}

TEST_CASE("What is in no output is in no map") {
  const TemporaryFolder folder;
  CleanPaths paths;
  paths.map = folder.path() / "map.pcd";
  paths.labelled = folder.path() / "labelled.pcd";
  write(paths, four_points(), {}, {2, 0, 1, 2});
  CHECK(column(read_records(paths.map), "ring") == std::vector<double>{1});
  CHECK(column(read_records(paths.labelled), "ring") == std::vector<double>{1, 2});
}

TEST_CASE("A field `label` of the input stays, and ours has another name") {
  const TemporaryFolder folder;
  RecordLayout layout = driver_layout();
  layout.fields[4].name = "label";
  CleanPaths paths;
  paths.labelled = folder.path() / "map.pcd";
  write(paths, four_points(layout));
  const PointRecords rows = read_records(paths.labelled);
  CHECK(column(rows, "label") == std::vector<double>{0, 1, 2, 3});
  CHECK(column(rows, "raymoval_label") == std::vector<double>{9, 9, 251, 251});
}

TEST_CASE("A labelled map of voxels keeps what was removed apart") {
  const TemporaryFolder folder;
  CleanPaths paths;
  paths.labelled = folder.path() / "map.pcd";
  CleanWriting writing;
  writing.voxel_size = 1000.0;
  write(paths, four_points(), writing);
  const PointRecords rows = read_records(paths.labelled);
  CHECK(column(rows, "label") == std::vector<double>{9, 251, 251});
  CHECK(column(rows, "x")[0] == Approx(10.2));
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

TEST_CASE("Intensities that LAS shows as 0 or 1 are told, and a scale spreads them") {
  const TemporaryFolder folder;
  const auto scans = four_points();  // All have 0.5.
  const Sequence sequence = sequence_of(scans);
  CleanPaths paths;
  paths.map = folder.path() / "map.las";
  const auto results = [&](std::optional<double> scale, double voxel) {
    CleanWriting writing;
    writing.intensity_scale = scale;
    writing.voxel_size = voxel;
    CleanOutputs outputs(paths, writing, sequence, no_progress(), kGoOn);
    outputs.add(scans->load(0), kTwoRemoved);
    outputs.commit();
    return outputs.results();
  };
  const std::vector<std::string> faint = results({}, 0.0);
  REQUIRE(faint.size() == 1);
  CHECK_THAT(faint[0], Contains("-o: 2 of 2 intensities lie between 0 and 1") &&
                           Contains("'intensity_1'") && Contains("--intensity-scale 65535"));
  paths.overwrite = true;
  for (const double voxel : {0.0, 0.1}) {
    CHECK(results(1000.0, voxel).empty());
    CHECK(column(read_records(paths.map), "intensity") == std::vector<double>{500, 500});
    CHECK(column(read_records(paths.map), "intensity_1") == std::vector<double>{0.5, 0.5});
  }
  const std::vector<std::string> large = results(1e6, 0.0);
  REQUIRE(large.size() == 1);
  CHECK_THAT(large[0], Contains("2 points with an intensity of more than 65,535"));
  CHECK(column(read_records(paths.map), "intensity") == std::vector<double>{65535, 65535});
}

TEST_CASE("A scale of intensities needs a file that shows them as whole numbers") {
  const TemporaryFolder folder;
  CleanPaths paths;
  paths.map = folder.path() / "map.ply";
  CleanWriting writing;
  writing.intensity_scale = 255.0;
  CHECK_THROWS_WITH(write(paths, four_points(), writing),
                    Contains("--intensity-scale has no effect") && Contains(".las"));
  paths.map = folder.path() / "map.las";
  CHECK_THROWS_AS(
      write(paths, four_points(parse_point_layout("x y z intensity:u2 ring:u2")), writing),
      UsageError);
  CHECK(entries_of(folder.path()).empty());
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
