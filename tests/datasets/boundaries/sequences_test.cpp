// SPDX-License-Identifier: MIT
// Messages of a sequence on its files, at the limits between left out, chosen and refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/files/files.h"
#include "core/scan/sensor_model.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/layouts.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "datasets/reading/loaded_data.h"
#include "datasets/semantickitti/semantickitti.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// A folder with one scan of rows x y z reflectance.
Sequence one_scan(const TemporaryFolder& folder, const std::vector<float>& values,
                  const std::string& pose = kIdentityRow) {
  folder.write("000000.bin", floats(values));
  folder.write("poses.txt", pose);
  return open_sequence(folder.text(), {});
}

/// The messages for a scan of `points` points, of which the first is no return.
std::vector<std::string> lines_of(std::size_t points) {
  const TemporaryFolder folder;
  std::vector<float> values(4 * points, 1.0F);
  values[0] = std::nanf("");
  const Sequence sequence = one_scan(folder, values);
  (void)sequence.scans->load(0);
  return left_out_lines(sequence);
}

std::string world_pcd(const std::string& fields, const std::string& viewpoint,
                      const std::string& row) {
  const bool intensity = fields != "x y z";
  return "FIELDS " + fields + "\nSIZE 4 4 4" + (intensity ? " 4" : "") + "\nTYPE F F F" +
         (intensity ? " F" : "") + "\nWIDTH 1\nHEIGHT 1\nVIEWPOINT " + viewpoint +
         "\nDATA ascii\n" + row + "\n";
}

template <class Value>
void add(std::string& bytes, const std::vector<Value>& values) {
  bytes += bytes_of<std::uint64_t>({values.size()}) + bytes_of(values);
}

void add(std::string& bytes, const Pose& pose) {
  const Eigen::Matrix4d matrix = pose.matrix();
  bytes += std::string(reinterpret_cast<const char*>(matrix.data()), 16 * sizeof(double));
}

/// The bytes of the settings of all scans.
std::string settings_by_hand(const Sequence& sequence) {
  const SensorModel& s = sequence.scans->sensor();
  std::string whole = bytes_of<double>(
      {s.azimuth_min, s.azimuth_max, s.elevation_min, s.elevation_max, s.azimuth_step,
       s.elevation_step, s.range_min, s.range_max, s.missing_return_is_meaningful ? 1.0 : 0.0,
       sequence.range_m.min, sequence.range_m.max, sequence.labels ? 1.0 : 0.0});
  add(whole, sequence.label_rule.moving);
  add(whole, sequence.label_rule.ignored);
  const Eigen::Vector3d up = sequence.up().direction;
  if (up != Eigen::Vector3d(0, 0, 1)) whole += bytes_of<double>({up.x(), up.y(), up.z()});
  return whole;
}

/// The fingerprint by its description: the bytes of the settings, then hashes of scans.
std::string fingerprint_by_hand(const Sequence& sequence) {
  std::string whole = settings_by_hand(sequence);
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const Scan scan = sequence.scans->load(i);
    std::string bytes = bytes_of<double>({scan.time_s});
    add(bytes, scan.T_world_sensor);
    std::vector<float> coordinates;
    for (const Eigen::Vector3f& p : scan.points) {
      coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
    }
    bytes += bytes_of<std::uint64_t>({scan.size()}) + floats(coordinates);
    add(bytes, scan.reflectance);
    if (sequence.labels) add(bytes, sequence.labels->labels(scan));
    whole += content_hash(bytes);
  }
  return content_hash(whole);
}

const Layout& layout_named(const std::string& name) {
  Sequence sequence;
  sequence.layout = name;
  return layout_of(sequence);
}

}  // namespace

TEST_CASE("shares of missing returns are told with the digits that they have", "[no-returns]") {
  const std::string rest = " are missing returns (NaN or at the origin) and are left out";
  using Lines = std::vector<std::string>;
  CHECK(lines_of(66) == Lines{"1.5 % of the stored points" + rest});
  CHECK(lines_of(100) == Lines{"1.0 % of the stored points" + rest});
  CHECK(lines_of(101) == Lines{"0.99 % of the stored points" + rest});
  CHECK(lines_of(200) == Lines{"0.50 % of the stored points" + rest});
  CHECK(lines_of(10000) == Lines{"0.01 % of the stored points" + rest});
  CHECK(lines_of(10001) == Lines{"1 of 10,001 stored points" + rest});
}

TEST_CASE("a point is at the sensor if it is nearer than five centimetres", "[no-returns]") {
  const TemporaryFolder folder;
  const Scan scan =
      one_scan(folder, {0.04F, 0, 0,      0, 0,     0.049F, 0,     0, 0.05F, 0, 0, 0,  //
                        0,     0, -0.06F, 0, 0.03F, 0.03F,  0.03F, 0})
          .scans->load(0);
  CHECK(scan.stored_index == std::vector<std::uint32_t>{2, 3, 4});
}

TEST_CASE("a point of the world is at its origin if it is nearer than a millimetre",
          "[no-returns]") {
  for (const auto& [x, kept] : std::vector<std::pair<std::string, bool>>{
           {"0.0007", false}, {"0.001", true}, {"-0.0015", true}, {"-0.0009", false}}) {
    const TemporaryFolder folder;
    folder.write("pcd/0.pcd", world_pcd("x y z", "100 0 2 1 0 0 0", x + " 0 0"));
    const Sequence sequence = open_sequence(folder.text(), {});
    CAPTURE(x);
    if (kept) {
      CHECK((sequence.scans->load(0).points.at(0) - Eigen::Vector3f(-100, 0, -2)).norm() < 0.01F);
    } else {
      CHECK(sequence.scans->load(0).points.empty());
    }
  }
}

TEST_CASE("a scan of 99 missing returns and one infinite point has no return", "[no-returns]") {
  const TemporaryFolder folder;
  std::vector<float> values(400, std::nanf(""));
  for (int i = 0; i < 4; ++i) values[i] = std::numeric_limits<float>::infinity();
  const Sequence sequence = one_scan(folder, values);
  CHECK(sequence.scans->load(0).points.empty());
}

TEST_CASE("points in the sensor's frame stay as they are wherever the sensor stands", "[files]") {
  const TemporaryFolder folder;
  const Sequence sequence =
      one_scan(folder, {1, 2, 3, 4}, "1 0 0 691000 0 1 0 5336000 0 0 1 500\n");
  CHECK(sequence.poses_file == "poses.txt");
  CHECK(sequence.scans->load(0).points.at(0) == Eigen::Vector3f(1, 2, 3));
  CHECK_THROWS_AS(sequence.scans->load(1), InternalError);
  CHECK_THROWS_AS(sequence.scans->pose(1), InternalError);
}

TEST_CASE("scans without times are a period apart", "[files]") {
  const TemporaryFolder folder;
  for (const char* name : {"a.bin", "b.bin", "c.bin"}) write_cloud(folder / name, {{1, 2, 3}});
  folder.write("poses.txt", kIdentityRow + kIdentityRow + kIdentityRow);
  CHECK(open_sequence(folder.text(), {}).scans->load(2).time_s == 2 * 0.1);
  folder.write("sequence.json", R"({"scan_period_s": 0.5})");
  CHECK(open_sequence(folder.text(), {}).scans->load(2).time_s == 1.0);
  folder.write("sequence.json", R"({"scan_period_s": 0})");
  CHECK_THROWS_WITH(open_sequence(folder.text(), {}), Catch::Contains("a number above 0"));
}

TEST_CASE("times of a DynamicMap count from the first file", "[dynamicmap]") {
  const TemporaryFolder folder;
  for (const char* name : {"pcd/07.pcd", "pcd/09.pcd"}) {
    folder.write(name, world_pcd("x y z", "0 0 0 1 0 0 0", "1 2 3"));
  }
  SequenceOptions options;
  options.frames = parse_frame_range("9:9");
  CHECK(open_sequence(folder.text(), options).scans->load(0).time_s == 2 * 0.1);
  folder.write("sequence.json", R"({"scan_period_s": 0.5})");
  CHECK(open_sequence(folder.text(), {}).scans->load(1).time_s == 1.0);
}

TEST_CASE("labels in the intensity go up to 2^24, and need an intensity", "[dynamicmap]") {
  const TemporaryFolder folder;
  folder.write("sequence.json", R"({"labels": {}})");
  folder.write("pcd/0.pcd", world_pcd("x y z intensity", "0 0 0 1 0 0 0", "1 2 3 16777215"));
  const Sequence sequence = open_sequence(folder.text(), {});
  // The rule of this layout holds where none is given: 1 moves.
  CHECK(sequence.label_rule.moving == std::vector<std::uint16_t>{1});
  CHECK(sequence.label_rule.ignored.empty());
  CHECK(sequence.labels->labels(sequence.scans->load(0)) == std::vector<std::uint32_t>{16777215});
  folder.write("pcd/0.pcd", world_pcd("x y z", "0 0 0 1 0 0 0", "1 2 3"));
  const Scan scan = sequence.scans->load(0);
  CHECK_THROWS_WITH(sequence.labels->labels(scan), Catch::Contains("0 intensities for 1 points"));
}

TEST_CASE("a fingerprint is what it is described as", "[fingerprint]") {
  const TemporaryFolder folder;
  write_cloud(folder / "1.bin", {{1, 2, 3}, {4, 5, 6}}, {0.5F, 7});
  write_cloud(folder / "2.bin", {{7, 8, 9}}, {0.25F});
  folder.write("poses.txt", "0 -1 0 1 1 0 0 2 0 0 1 3\n" + kIdentityRow);
  folder.write("rule.json", R"({"moving": [252, 253], "ignored": [0]})");
  std::vector<std::string> prints;
  const auto check = [&](const SequenceOptions& options) {
    const Sequence sequence = open_sequence(folder.text(), options);
    prints.push_back(fingerprint(sequence, 1));
    CHECK(prints.back() == fingerprint_by_hand(sequence));
    std::string all = settings_by_hand(sequence);
    for (std::size_t i = 0; i < sequence.scans->size(); ++i) add(all, sequence.scans->pose(i));
    CHECK(watched(sequence).loaded().settings == content_hash(all));
  };
  for (const std::string& sensor : sensor_model_names()) {
    SequenceOptions options;
    options.sensor = sensor;
    options.up = "z";
    check(options);
    options.up = "-y";
    check(options);
    options.range_m = RangeLimits{2.0, 50.0};
    options.label_rule = folder / "rule.json";
    check(options);
  }
  folder.write("labels/1.label", words({9, 252}));
  folder.write("labels/2.label", words({1}));
  check({});
  std::sort(prints.begin(), prints.end());
  CHECK(std::unique(prints.begin(), prints.end()) == prints.end());
}

TEST_CASE("each layout says where its scans, poses and labels are", "[layouts]") {
  const Layout& kitti = layout_named("semantickitti");
  CHECK(kitti.scan_folder == "velodyne");
  CHECK(kitti.calibration_file == "calib.txt");
  CHECK(kitti.pose_place == PosePlace::kRowOfFrameNumber);
  CHECK_FALSE(kitti.labels_in_intensity);
  CHECK(kitti.class_names.contains(0));
  CHECK(kitti.class_names.contains(252));
  const Layout& root = layout_named("semantickitti root");
  CHECK(root.scan_folder == "velodyne");
  CHECK(root.expected == "a SemanticKITTI root as ROOT:05 or ROOT:kitti-05 (sequences/NN)");
  CHECK(root.forms.size() == 6);
  CHECK(root.forms[0].first == "ROOT:05");
  CHECK(root.forms[1].first == "ROOT:kitti-00");
  CHECK_THAT(root.forms[1].second, Catch::Contains("sequence 00, frames 4390:4530:2"));
  REQUIRE(root.folder_of);
  CHECK(root.folder_of("a/b:kitti-05") == "a/b/sequences/05");
  CHECK(root.folder_of("a/b:17") == "a/b/sequences/17");
  const Layout& world = layout_named("dynamicmap");
  CHECK(world.scan_folder == "pcd");
  CHECK(world.calibration_file.empty());
  CHECK(world.pose_place == PosePlace::kScanFile);
  CHECK(world.labels_in_intensity);
  CHECK_FALSE(world.class_names.contains(0));
  CHECK_FALSE(world.class_names.contains(1));
  CHECK(world.class_names.contains(252));
  const Layout& files = layout_named("files");
  CHECK(files.scan_folder.empty());
  CHECK(files.pose_place == PosePlace::kRowOfScan);
  CHECK(files.class_names == kitti.class_names);
  CHECK(layout_named("unheard of").name.empty());
  // Where labels are expected.
  CHECK(files.expected_labels == "a folder labels/ beside the scans");
  CHECK(kitti.expected_labels == files.expected_labels);
  CHECK_THAT(world.expected_labels, Catch::Contains("--label-rule FILE") &&
                                        Catch::Contains("intensity") &&
                                        Catch::Contains(R"({"moving": [1]})"));
  CHECK_THAT(layout_named("bags").expected_labels, Catch::Contains("indices.csv"));
  for (const Layout& layout : layouts()) {
    CAPTURE(layout.name);
    CHECK_FALSE(layout.expected.empty());
    CHECK_FALSE(layout.forms.empty());
  }
}

TEST_CASE("ranges of an option are checked like those of a file", "[settings]") {
  const TemporaryFolder folder;
  (void)one_scan(folder, {1, 2, 3, 4});
  const auto opened = [&](double min, double max) {
    SequenceOptions options;
    options.range_m = RangeLimits{min, max};
    return open_sequence(folder.text(), options).range_m;
  };
  CHECK(opened(0, 0.5).max == 0.5);
  for (const auto& [min, max] :
       std::vector<std::pair<double, double>>{{-1, 5}, {5, 5}, {6, 5}, {std::nan(""), 5}}) {
    CHECK_THROWS_AS(opened(min, max), ConfigurationError);
  }
}

TEST_CASE("a segment of one frame is named as a range, and a user's range is the user's",
          "[semantickitti]") {
  const TemporaryFolder folder;
  const std::string at = "sequences/05/";
  folder.write(at + "velodyne/000000.bin", floats({1, 2, 3, 4}));
  folder.write(at + "poses.txt", kIdentityRow);
  folder.write(at + "calib.txt", "Tr: 0 -1 0 1 0 0 -1 2 1 0 0 3\n");
  const auto says = [&](const SequenceOptions& options) {
    return message_of<DataError>([&] { open_sequence(folder.text() + ":kitti-05", options); });
  };
  check_says(says({}), {"the data has 1 frame from 0 to 0", ":05 --frames 0:0."});
  SequenceOptions options;
  options.frames = parse_frame_range("3:4");
  check_says(says(options), {"--frames 3:4:1 reaches outside"});
  const Sequence sequence = open_sequence(folder.text() + ":05", {});
  REQUIRE(sequence.T_camera_lidar);
  CHECK(sequence.T_camera_lidar->translation() == Eigen::Vector3d(1, 2, 3));
  folder.write(at + "sequence.json", R"({"poses_are_lidar": true})");
  CHECK_FALSE(open_sequence(folder.text() + ":05", {}).T_camera_lidar);
}

TEST_CASE("a missing return stored as zero is none in a world far from its origin either",
          "[no-returns]") {
  for (const char* place : {"8000 0 0", "8001 0 0", "691000.25 5336000.5 512"}) {
    const TemporaryFolder folder;
    folder.write("pcd/0.pcd", world_pcd("x y z", std::string(place) + " 1 0 0 0", "0 0 0"));
    const Sequence sequence = open_sequence(folder.text(), {});
    CHECK(sequence.scans->load(0).points.empty());
  }
}

TEST_CASE("a segment without its root, and a root without sequences, are told", "[semantickitti]") {
  const TemporaryFolder folder;
  check_says(message_of<DataError>([] { open_sequence("kitti-05", {}); }),
             {"kitti-05: no such folder; the segment of that name is ROOT:kitti-05"});
  check_says(message_of<UsageError>([&] { open_sequence(folder.text() + ":05", {}); }),
             {"holds no folder sequences/"});
}

TEST_CASE("what is left out of the own vehicle is told once something was read", "[ego]") {
  const TemporaryFolder folder;
  folder.write("sequence.json", R"({"drop_ego": 1.5})");
  const Sequence one = one_scan(folder, {9, 0, 0, 0});
  CHECK(left_out_lines(one).empty());
  (void)one.scans->load(0);
  CHECK(
      left_out_lines(one) ==
      std::vector<std::string>{"no point is on the ego vehicle (nearer than 1.5 m) and left out"});
  const Sequence two = one_scan(folder, {9, 0, 0, 0, 1, 0, 0, 0});
  (void)two.scans->load(0);
  CHECK(left_out_lines(two) ==
        std::vector<std::string>{"50.0 % of the stored points are on the ego vehicle (nearer than "
                                 "1.5 m) and are left out"});
}

TEST_CASE("data that changed before, or has other counts, has changed", "[fingerprint]") {
  LoadedData before;
  before.names = before.scans = before.labels = {"a", "b"};
  CHECK(changed_data(before, before).empty());
  LoadedData after = before;
  after.change = "this one";
  CHECK(changed_data(before, after) == "this one");
  CHECK(changed_data(after, before) == "this one");
  after = before;
  after.labels.pop_back();
  CHECK_THAT(changed_data(before, after), Catch::Contains("it had 2 scans"));
  after = before;
  after.scans.pop_back();
  CHECK_THAT(changed_data(before, after), Catch::Contains("it had 2 scans and has 1"));
}

TEST_CASE("a fingerprint tells whether missing returns mean something", "[fingerprint]") {
  SequenceOptions options;
  options.frames = parse_frame_range("0:0");
  options.up = "z";
  const Sequence street = open_sequence("street", options);
  REQUIRE(street.scans->sensor().missing_return_is_meaningful);
  CHECK(fingerprint(street, 1) == fingerprint_by_hand(street));
}
