// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/fingerprint.h"
#include "tests/datasets/open_folders.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string world_pcd(const std::string& viewpoint, const std::string& rows, int points) {
  const std::string count = std::to_string(points);
  return "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " +
         count + "\nHEIGHT 1\nVIEWPOINT " + viewpoint + "\nPOINTS " + count + "\nDATA ascii\n" +
         rows;
}

void write_dynamicmap(const TemporaryFolder& folder) {
  folder.write("pcd/000007.pcd", world_pcd("0 0 0 1 0 0 0", "1 2 3 0\n4 5 6 1\n", 2));
  // The sensor is at (10, 0, 1), rotated left by 90 degrees: its x is the world's y.
  folder.write("pcd/000008.pcd", world_pcd("10 0 1 0.7071067811865476 0 0 0.7071067811865476",
                                           "10 2 1 1\n7 0 5 0\n", 2));
}

}  // namespace

TEST_CASE("DynamicMap points in UTM coordinates come back to the millimetre", "[dynamicmap]") {
  const TemporaryFolder folder;
  // A quarter turn to the left: x of the world is -y of the sensor.
  std::string pcd = world_pcd("691000.25 5336000.5 512 0.7071067811865476 0 0 0.7071067811865476",
                              "691010.3734 5335995.9326 513.7341 0\n", 1);
  folder.write("pcd/000000.pcd", pcd);
  const Scan scan = open_sequence(folder.text(), {}).scans->load(0);
  const Eigen::Vector3d expected(-4.5674, -10.1234, 1.7341);
  CHECK((scan.points.at(0).cast<double>() - expected).norm() < 1e-5);
}

TEST_CASE("DynamicMap points go from the world back to the sensor, once", "[dynamicmap]") {
  const TemporaryFolder folder;
  write_dynamicmap(folder);
  folder.write("gt_cloud.pcd", world_pcd("0 0 0 1 0 0 0", "1 2 3 0\n", 1));
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(sequence.layout == "dynamicmap");
  CHECK(sequence.frames == "7:8:1");
  CHECK(sequence.poses_file == "VIEWPOINT");
  REQUIRE(sequence.scans->size() == 2);
  const Scan still = sequence.scans->load(0);
  CHECK(still.name == "000007");
  CHECK(still.points[1] == Eigen::Vector3f(4, 5, 6));
  const Scan scan = sequence.scans->load(1);
  // (10, 2, 1) lies 2 m along the world's y, so 2 m ahead. (7, 0, 5) lies 3 m along -x, which is
  // the sensor's +y, and 4 m up.
  CHECK((scan.points[0] - Eigen::Vector3f(2, 0, 0)).norm() < 1e-5F);
  CHECK((scan.points[1] - Eigen::Vector3f(0, 3, 4)).norm() < 1e-5F);
  CHECK((scan.T_world_sensor * scan.points[1].cast<double>() - Eigen::Vector3d(7, 0, 5)).norm() <
        1e-5);
  CHECK(scan.time_s == Approx(0.1));
  // Intensity may be the answer, so no method gets it.
  CHECK(scan.reflectance.empty());
  CHECK_FALSE(sequence.labels);
}

TEST_CASE("DynamicMap intensity is a label only where a rule says so", "[dynamicmap]") {
  const TemporaryFolder folder;
  write_dynamicmap(folder);
  folder.write("sequence.json", R"({"labels": {"moving": [1]}})");
  const Sequence sequence = open_sequence(folder.text(), {});
  REQUIRE(sequence.labels);
  CHECK(sequence.labels->labels(sequence.scans->load(0)) == std::vector<std::uint32_t>{0, 1});
  CHECK(sequence.labels->labels(sequence.scans->load(1)) == std::vector<std::uint32_t>{1, 0});
  CHECK(sequence.label_rule.classify(1) == LabelClass::kMoving);
  CHECK(sequence.label_rule.classify(252) == LabelClass::kStatic);
  for (const char* intensity : {"0.5", "-1", "nan", "16777216"}) {
    folder.write("pcd/000007.pcd",
                 world_pcd("0 0 0 1 0 0 0", "1 2 3 0\n4 5 6 " + std::string(intensity) + "\n", 2));
    check_says(
        message_of<DataError>([&] { (void)sequence.labels->labels(sequence.scans->load(0)); }),
        {"000007.pcd", "point 1", intensity, "not a label"});
  }
}

TEST_CASE("a folder of mixed scan files opens in natural order", "[files]") {
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {4, 5, 6}};
  write_cloud(folder / "scan_2.pcd", points, {0.5F, 0.25F});
  write_cloud(folder / "scan_10.ply", points);
  write_cloud(folder / "scan_1.bin", points, {7, 8});
  folder.write("poses.txt", "# t x y z q\n5 1 0 0 0 0 0 1\n5.5 2 0 0 0 0 0 1\n7 10 0 0 0 0 0 1\n");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(sequence.layout == "files");
  REQUIRE(sequence.scans->size() == 3);
  const std::vector<std::string> names = {"scan_1", "scan_2", "scan_10"};
  const std::vector<double> x = {1, 2, 10}, time = {0, 0.5, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    const Scan scan = sequence.scans->load(i);
    CHECK(scan.name == names[i]);
    CHECK(scan.points == points);
    CHECK(scan.T_world_sensor.translation().x() == x[i]);
    CHECK(scan.time_s == time[i]);
  }
  CHECK(sequence.scans->load(1).reflectance == std::vector<float>{0.5F, 0.25F});
  CHECK(sequence.scans->load(2).reflectance.empty());
  CHECK_FALSE(sequence.labels);
  SequenceOptions options;
  options.frames = parse_frame_range("2:2");
  CHECK(open_sequence(folder.text(), options).scans->load(0).name == "scan_10");
}

TEST_CASE("a folder of scans needs one pose a scan and one file a scan", "[files]") {
  const TemporaryFolder folder;
  write_cloud(folder / "a.pcd", {{1, 2, 3}});
  write_cloud(folder / "b.pcd", {{1, 2, 3}});
  check_says(open_error(folder.text()), {"no pose file 'poses.txt'", "found no .txt", "--poses"});
  for (const int rows : {3, 4}) {
    std::string poses;
    for (int i = 0; i < rows; ++i) poses += kIdentityRow;
    folder.write("poses.txt", poses);
    check_says(open_error(folder.text()),
               {std::to_string(rows) + " poses", "2 scans", "a.pcd to b.pcd"});
  }
  folder.write("poses.txt", kIdentityRow + kIdentityRow);
  CHECK(open_sequence(folder.text(), {}).scans->size() == 2);
  write_cloud(folder / "a.bin", {{1, 2, 3}});
  check_says(open_error(folder.text()), {"a.pcd", "also a.bin"});
}

TEST_CASE("the sensor is estimated when none is named", "[files]") {
  const TemporaryFolder folder;
  std::string poses;
  for (int i = 0; i < 7; ++i) {
    // Of seven scans 0, 1, 3, 4 and 6. Scan 1 alone has the nearest point; 2 and 5 the farthest.
    const float far = i == 2 || i == 5 ? 90.0F : 9.0F;
    write_cloud(folder / ("s" + std::to_string(i) + ".bin"),
                {{i == 1 ? 1.0F : 5.0F, 0, 0}, {0, far, 0}});
    poses += kIdentityRow;
  }
  folder.write("poses.txt", poses);
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(sequence.scans->sensor().name == "estimated");
  CHECK(sequence.scans->sensor().range_min == 1.0);
  CHECK(sequence.scans->sensor().range_max == 9.0);
  CHECK(sequence.record().sensor == "estimated");
  CHECK_FALSE(sequence.record().scan_period_s);
  SequenceOptions options;
  options.sensor = "vlp16";
  CHECK(open_sequence(folder.text(), options).scans->sensor().name == "vlp16");
}

TEST_CASE("a fingerprint changes with the data and with nothing else", "[fingerprint]") {
  const TemporaryFolder folder, copy;
  const auto fill = [](const TemporaryFolder& at, const std::string& prefix, float x,
                       std::uint32_t label, const std::string& poses) {
    write_cloud(at / (prefix + "1.bin"), {{1, 2, 3}, {4, 5, 6}}, {0, 0});
    write_cloud(at / (prefix + "2.bin"), {{x, 2, 3}}, {0});
    at.write("poses.txt", poses);
    at.write("labels/" + prefix + "1.label", words({40, 40}));
    at.write("labels/" + prefix + "2.label", words({label}));
  };
  const auto print = [](const TemporaryFolder& at, const SequenceOptions& options = {},
                        int threads = 1) {
    return fingerprint(open_sequence(at.text(), options), threads);
  };
  const std::string still = kIdentityRow + kIdentityRow;
  const std::string moved = kIdentityRow + "1 0 0 1e-9 0 1 0 0 0 0 1 0\n";
  fill(folder, "a", 1, 40, still);
  const std::string original = print(folder);
  CHECK(original.size() == 32);
  CHECK(print(folder, {}, 2) == original);
  CHECK(print(folder, {}, 8) == original);
  fill(copy, "other", 1, 40, still);
  CHECK(print(copy) == original);
  fill(folder, "a", 1.0000001F, 40, still);
  CHECK(print(folder) != original);
  fill(folder, "a", 1, 252, still);
  CHECK(print(folder) != original);
  fill(folder, "a", 1, 40, moved);
  CHECK(print(folder) != original);
  fill(folder, "a", 1, 40, still);
  CHECK(print(folder) == original);
  SequenceOptions options;
  options.frames = parse_frame_range("0:0");
  CHECK(print(folder, options) != original);
  options = {};
  options.range_m = RangeLimits{0, 50};
  CHECK(print(folder, options) != original);
  options = {};
  options.name = "renamed";
  CHECK(print(folder, options) == original);
}
