// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_rows.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/clouds/format/field_names.h"
#include "tests/benchmark/clean/recorded_scans.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;

namespace {

/// A quarter turn to the left, seen from (10, 20, 0).
Pose turned() {
  Pose pose(Eigen::Translation3d(10.0, 20.0, 0.0));
  pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return pose;
}

ScanRows rows_of(const Sequence& sequence, std::size_t scan,
                 Coordinates coordinates = Coordinates::kFloat) {
  const MapRows rows(sequence, coordinates, no_progress(), kGoOn);
  const PointRecords stored = sequence.records->records(scan);
  return rows.rows(sequence.scans->load(scan), &stored);
}

}  // namespace

TEST_CASE("All fields but the position go through bit for bit") {
  const double time = 1317384506.4000001;
  const auto scans = std::make_shared<RecordedScans>(
      std::vector{records_of(driver_layout(), {{1, 2, 3, 0.5, 65535, time}})},
      std::vector{turned()});
  const ScanRows made = rows_of(sequence_of(scans), 0);
  CHECK(made.rows.layout == driver_layout());
  CHECK(made.world[0] == Eigen::Vector3d(8.0, 21.0, 3.0));
  CHECK(value_of(made.rows, 0, "x") == 8.0);
  CHECK(value_of(made.rows, 0, "y") == 21.0);
  CHECK(value_of(made.rows, 0, "ring") == 65535.0);
  CHECK(value_of(made.rows, 0, "time") == time);
  CHECK(made.rows.bytes.back() == std::byte{7});
}

TEST_CASE("Far from the origin coordinates become float64, and nothing else changes") {
  Pose far = turned();
  far.translation().x() = 691000.25;
  const auto scans = std::make_shared<RecordedScans>(
      std::vector{records_of(driver_layout(), {{1, 2, 3, 0.5, 7, 9}})}, std::vector{far});
  const Sequence sequence = sequence_of(scans);
  CHECK(MapRows(sequence, Coordinates::kDouble, no_progress(), kGoOn).is_widened());
  const ScanRows made = rows_of(sequence, 0, Coordinates::kDouble);
  CHECK(made.rows.layout.find({"x"})->size == 8);
  CHECK(value_of(made.rows, 0, "x") == 690998.25);
  CHECK(value_of(made.rows, 0, "intensity") == 0.5);
  CHECK(value_of(made.rows, 0, "ring") == 7.0);
}

TEST_CASE("Points that are stored in the world frame stay bit for bit") {
  const RecordLayout layout = parse_point_layout("x:f8 y:f8 z:f8");
  const double x = 691000.1234567891;
  const auto scans = std::make_shared<RecordedScans>(
      std::vector{records_of(layout, {{x, 1.1, 2.2}})}, std::vector{turned()}, PointFrame::kWorld);
  const ScanRows made = rows_of(sequence_of(scans), 0, Coordinates::kDouble);
  CHECK(made.rows.bytes == scans->records(0).bytes);
  CHECK(made.world[0].x() == x);
}

TEST_CASE("Stored doubles keep their digits, but for points that were moved") {
  const RecordLayout layout = parse_point_layout("x:f8 y:f8 z:f8");
  const double x = 1.1234567890123;
  const auto scans =
      std::make_shared<RecordedScans>(std::vector{records_of(layout, {{x, 0, 0}, {x, 0, 0}})},
                                      std::vector{Pose(Eigen::Translation3d(1.0, 0.0, 0.0))});
  const Sequence sequence = sequence_of(scans);
  const MapRows rows(sequence, Coordinates::kFloat, no_progress(), kGoOn);
  Scan scan = scans->load(0);
  scan.points[1].x() = 5.0F;  // As --deskew does.
  const PointRecords stored = scans->records(0);
  const ScanRows made = rows.rows(scan, &stored);
  CHECK(value_of(made.rows, 0, "x") == 1.0 + x);
  CHECK(value_of(made.rows, 1, "x") == 6.0);
}

TEST_CASE("Normals turn with their scan, and stay in the world frame") {
  RecordLayout layout;
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z"}) {
    layout.add(name, 'F', 4);
  }
  layout.add("normal", 'F', 4, 3);
  PointRecords rows = records_of(layout, {{0, 0, 0, 1, 0, 0}});
  for (int axis = 0; axis < 3; ++axis) rows.set_value(0, layout.fields[6], axis == 1 ? 1 : 0, axis);
  const auto made = [&](PointFrame frame) {
    return rows_of(sequence_of(std::make_shared<RecordedScans>(std::vector{rows},
                                                               std::vector{turned()}, frame)),
                   0)
        .rows;
  };
  const PointRecords sensor = made(PointFrame::kSensor);
  CHECK(value_of(sensor, 0, "normal_x") == 0.0);
  CHECK(value_of(sensor, 0, "normal_y") == 1.0);
  CHECK(sensor.value(0, layout.fields[6], 0) == -1.0);
  CHECK(made(PointFrame::kWorld).bytes == rows.bytes);
}

TEST_CASE("A scan with other fields is an error that names them, and their order does not matter") {
  RecordLayout other;
  other.add("ring", 'U', 2);
  for (const char* name : {"z", "y", "x", "intensity"}) other.add(name, 'F', 4);
  other.add("time", 'F', 8);
  const auto sequence = [&](const RecordLayout& second) {
    std::vector<double> row(second.fields.size(), 0.0);
    row[0] = 5;
    return sequence_of(std::make_shared<RecordedScans>(
        std::vector{records_of(driver_layout(), {{1, 2, 3, 4, 5, 6}}), records_of(second, {row})},
        std::vector<Pose>{Pose::Identity(), Pose::Identity()}));
  };
  CHECK(value_of(rows_of(sequence(other), 1).rows, 0, "ring") == 5.0);
  RecordLayout more = driver_layout();
  more.add("rgb", 'F', 4);
  CHECK_THROWS_WITH(rows_of(sequence(more), 0),
                    Contains("scan1.pcd: has a field 'rgb' as well") && Contains("same fields"));
  RecordLayout fewer = driver_layout();
  fewer.fields.pop_back();
  CHECK_THROWS_WITH(rows_of(sequence(fewer), 0), Contains("has no field 'time'"));
  RecordLayout wider = driver_layout();
  wider.fields[4].size = 1;
  CHECK_THROWS_WITH(rows_of(sequence(wider), 0),
                    Contains("has uint8 ring in place of uint16 ring"));
}

TEST_CASE("Without records a map has x, y, z and intensity") {
  auto scans = std::make_shared<RecordedScans>(
      std::vector{records_of(driver_layout(), {{1, 2, 3, 0.5, 7, 9}})}, std::vector{turned()});
  Sequence sequence = sequence_of(scans);
  sequence.records = nullptr;
  const MapRows rows(sequence, Coordinates::kFloat, no_progress(), kGoOn);
  Scan scan = scans->load(0);
  CHECK(value_of(rows.rows(scan, nullptr).rows, 0, "x") == 8.0);
  CHECK(value_of(rows.rows(scan, nullptr).rows, 0, "intensity") == 0.0);
  scan.reflectance = {0.75F};
  CHECK(value_of(rows.rows(scan, nullptr).rows, 0, "intensity") == 0.75);
}
