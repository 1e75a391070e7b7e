// SPDX-License-Identifier: MIT
#include "datasets/semantickitti/semantickitti.h"

#include <catch2/catch.hpp>
#include <limits>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "tests/datasets/open_folders.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string frame_name(int number) {
  std::string name = std::to_string(number);
  return name.insert(0, 6 - name.size(), '0');
}

/// `frames` scans of two points, (number, 2, 3) and (5, 6, 7), with labels 40 and 252 (instance 1),
/// poses that move by 1 along x a frame and an identity Tr.
void write_sequence(const TemporaryFolder& folder, const std::string& at, int frames) {
  std::string poses;
  for (int i = 0; i < frames; ++i) {
    folder.write(at + "velodyne/" + frame_name(i) + ".bin",
                 floats({static_cast<float>(i), 2, 3, 0.5F, 5, 6, 7, 0.25F}));
    folder.write(at + "labels/" + frame_name(i) + ".label", words({40, (1U << 16U) | 252U}));
    poses += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  }
  folder.write(at + "poses.txt", poses);
  folder.write(at + "calib.txt", "Tr: " + kIdentityRow);
}

SequenceOptions with_frames(const std::string& text) {
  SequenceOptions options;
  options.frames = parse_frame_range(text);
  return options;
}

}  // namespace

TEST_CASE("a sequence folder gives points, poses, labels and times", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 4);
  const Sequence sequence = open_sequence(folder.text(), with_frames("1:3:2"));
  CHECK(sequence.layout == "semantickitti");
  CHECK(sequence.frames == "1:3:2");
  CHECK(sequence.poses_file == "poses.txt");
  REQUIRE(sequence.scans->size() == 2);
  const Scan scan = sequence.scans->load(1);
  CHECK(scan.index == 1);
  CHECK(scan.name == "000003");
  CHECK(scan.time_s == Approx(0.3));
  CHECK(scan.points ==
        std::vector<Eigen::Vector3f>{Eigen::Vector3f(3, 2, 3), Eigen::Vector3f(5, 6, 7)});
  CHECK(scan.reflectance == std::vector<float>{0.5F, 0.25F});
  CHECK(scan.stored_point_count == 2);
  CHECK(scan.T_world_sensor.translation() == Eigen::Vector3d(3, 0, 0));
  CHECK(sequence.scans->pose(1).matrix() == scan.T_world_sensor.matrix());
  REQUIRE(sequence.labels);
  CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>{40, 65788});
  CHECK(sequence.label_rule.classify(65788) == LabelClass::kMoving);
  CHECK(sequence.label_rule.classify(0) == LabelClass::kStatic);
}

TEST_CASE("the LiDAR pose is Tr^-1 P Tr", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 2);
  // KITTI's axes: camera x = -LiDAR y, camera y = -LiDAR z, camera z = LiDAR x, moved by (1, 2, 3).
  folder.write("calib.txt", "Tr: 0 -1 0 1 0 0 -1 2 1 0 0 3\n");
  // The camera moves 10 forward (its z) and rotates by 90 degrees about its y (down), z to x: to
  // the right. In LiDAR axes: a rotation by -90 degrees about z.
  folder.write("poses.txt", kIdentityRow + "0 0 1 0 0 1 0 0 -1 0 0 10\n");
  const Pose pose = open_sequence(folder.text(), {}).scans->pose(1);
  // By hand for the LiDAR's origin: Tr gives (1, 2, 3); P gives (3, 2, -1 + 10) = (3, 2, 9);
  // minus (1, 2, 3) is (2, 0, 6) in camera axes; Tr's rotation undone: x = 6, y = -2, z = 0.
  CHECK((pose.translation() - Eigen::Vector3d(6, -2, 0)).norm() < 1e-12);
  // Ahead (x) becomes right (-y).
  CHECK((pose.linear() * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, -1, 0)).norm() < 1e-12);
}

TEST_CASE("without calib.txt the poses have to be declared the LiDAR's", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 2);
  std::filesystem::remove(folder / "calib.txt");
  check_says(open_error(folder.text()), {"calib.txt", "missing", "poses_are_lidar"});
  folder.write("sequence.json", R"({"poses_are_lidar": true})");
  CHECK(open_sequence(folder.text(), {}).scans->pose(1).translation().x() == 1.0);
}

TEST_CASE("a root opens by sequence number or by the name of a segment", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "sequences/05/", 3);
  write_sequence(folder, "sequences/01/", 252);
  const Sequence whole = open_sequence(folder.text() + ":05", {});
  CHECK(whole.name == "05");
  CHECK(whole.frames == "0:2:1");
  const Sequence segment = open_sequence(folder.text() + ":kitti-01", {});
  CHECK(segment.name == "kitti-01");
  CHECK(segment.frames == "150:250:1");
  CHECK(segment.scans->size() == 101);  // Both ends: table of the evaluation protocol.
  CHECK(open_sequence(folder.text() + ":kitti-01", with_frames("0:4:2")).scans->size() == 3);
  check_says(open_error(folder.text() + ":kitti-05"), {"2350:2670:2", "3 frames from 0 to 2"});
  check_says(open_error(folder.text() + ":kitti-05"), {folder.text() + ":05 --frames 0:2."});
  // The existing frames may have a stride, or match no range.
  std::filesystem::remove(folder / "sequences/05/velodyne/000001.bin");
  check_says(open_error(folder.text() + ":kitti-05"), {"2 frames", ":05 --frames 0:2:2."});
  std::filesystem::remove(folder / "sequences/05/velodyne/000000.bin");
  check_says(open_error(folder.text() + ":kitti-05"), {"1 frame from 2 to 2", ":05 --frames 2:2."});
  std::filesystem::remove(folder / "sequences/01/velodyne/000001.bin");
  std::filesystem::remove(folder / "sequences/01/velodyne/000151.bin");
  check_says(open_error(folder.text() + ":kitti-01"), {"250 frames from 0 to 251", ":01."});
  check_says(open_error(folder.text() + ":kitti-07"), {"sequences/07", "no such folder"});
  check_says(open_error<UsageError>(folder.text() + ":kiti-01"), {"Did you mean 'kitti-01'"});
  check_says(open_error<UsageError>(folder.text() + ":99"), {"'99'", "01, 05, kitti-00"});
  check_says(open_error<UsageError>(folder.text()), {"01/, 05/", "such as"});
}

TEST_CASE("poses and scans that do not fit are told with both counts", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 3);
  folder.write("poses.txt", kIdentityRow + kIdentityRow);
  check_says(open_error(folder.text()), {"poses.txt", "2 poses", "3 scans", "frame 2"});
  // More rows than scans: a partial copy, frame number = row.
  write_sequence(folder, "", 3);
  std::filesystem::remove(folder / "velodyne/000000.bin");
  const Sequence partial = open_sequence(folder.text(), {});
  CHECK(partial.scans->size() == 2);
  CHECK(partial.scans->pose(0).translation().x() == 1.0);
  // A bad row counts only if its frame is used.
  folder.write("poses.txt", kIdentityRow + kIdentityRow + "nan 0 0 0 0 1 0 0 0 0 1 0\n");
  check_says(open_error(folder.text()), {"poses.txt: 1 of 2 scans have no pose", "nan"});
  CHECK(open_sequence(folder.text(), with_frames("1:1")).scans->size() == 1);
}

TEST_CASE("times.txt gives seconds since frame 0", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 3);
  folder.write("times.txt", "1.000000e+01\n1.025000e+01\n1.5e+01\n");
  CHECK(open_sequence(folder.text(), {}).scans->load(1).time_s == 0.25);
  CHECK(open_sequence(folder.text(), with_frames("2:2")).scans->load(0).time_s == 5.0);
  folder.write("times.txt", "0\n1\n");
  check_says(open_error(folder.text()), {"times.txt", "2 times", "3 scans"});
  folder.write("times.txt", "0\n1 2\n3\n");
  check_says(open_error(folder.text()), {"times.txt: line 2", "expected a time"});
}

TEST_CASE("labels have to fit their scan", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 2);
  folder.write("labels/000001.label", words({1, 2, 3}));
  const Sequence sequence = open_sequence(folder.text(), {});
  const auto read = [&] { (void)sequence.labels->labels(sequence.scans->load(1)); };
  check_says(message_of<DataError>(read), {"000001.label", "3 labels", "000001.bin", "2 points"});
  folder.write("labels/000001.label", words({1, 2}) + "x");
  check_says(message_of<DataError>(read), {"9 bytes"});
  std::filesystem::remove(folder / "labels/000001.label");
  const Sequence partial = open_sequence(folder.text(), {});
  CHECK(partial.losses ==
        std::vector<std::string>{"1 of 2 scans have labels in labels/; only these are scored."});
  CHECK(partial.labels->labels(partial.scans->load(1)) == std::vector<std::uint32_t>(2, 65535));
  CHECK(partial.label_rule.classify(65535) == LabelClass::kIgnored);
  CHECK(open_sequence(folder.text(), with_frames("0:0")).losses.empty());
  // An empty file is none, and without any there are no labels.
  folder.write("labels/000000.label", "");
  const Sequence unlabelled = open_sequence(folder.text(), {});
  CHECK_FALSE(unlabelled.labels);
  check_says(unlabelled.notes.at(0), {"0 of 2 scans have labels", "no labels"});
  std::filesystem::remove_all(folder / "labels");
  const Sequence bare = open_sequence(folder.text(), {});
  CHECK_FALSE(bare.labels);
  CHECK_FALSE(bare.record().label_rule);
}

TEST_CASE("points without coordinates are left out and keep labels in step", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 1);
  // 200 points (i, 1, 0) with label i; point 3 has a NaN, points 7 and 8 an infinity: exactly 1 %.
  std::vector<float> values;
  std::vector<std::uint32_t> labels;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto x = static_cast<float>(i);
    values.insert(values.end(),
                  {i == 3 ? kNan : x, i == 7 || i == 8 ? 1.0F / 0.0F : 1.0F, 0.0F, x});
    labels.push_back(i);
  }
  folder.write("velodyne/000000.bin", floats(values));
  folder.write("labels/000000.label", words(labels));
  const Sequence sequence = open_sequence(folder.text(), {});
  const Scan scan = sequence.scans->load(0);
  CHECK(scan.size() == 197);
  CHECK(scan.stored_point_count == 200);
  CHECK(scan.left_out_count() == 3);
  const auto kept = sequence.labels->labels(scan);
  REQUIRE(kept.size() == 197);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    CHECK(scan.stored_position(i) == i + (i >= 3 ? 1 : 0) + (i >= 6 ? 2 : 0));
    CHECK(scan.points[i].x() == static_cast<float>(scan.stored_position(i)));
    CHECK(scan.reflectance[i] == scan.points[i].x());
    CHECK(kept[i] == scan.stored_position(i));
  }
  values[4 * 9] = 1.0F / 0.0F;  // A third: 1.5 %.
  folder.write("velodyne/000000.bin", floats(values));
  check_says(message_of<DataError>([&] { (void)sequence.scans->load(0); }),
             {"000000.bin", "3 of 200 points are infinite", "1 %"});
}

TEST_CASE("sequence.json is read, and options stand above it", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 2);
  folder.write("other.txt", kIdentityRow + kIdentityRow);
  folder.write("sequence.json", R"({"name": "drive", "source": "a test", "sensor": "hdl64e",
      "scan_period_s": 0.05, "poses": "other.txt", "range_m": {"min": 2.7, "max": 50.0},
      "labels": {"ignored": [0], "moving": [252]}})");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(sequence.name == "drive");
  CHECK(sequence.scans->sensor().name == "hdl64e");
  CHECK(sequence.scans->load(1).time_s == 0.05);
  CHECK(sequence.label_rule.classify(0) == LabelClass::kIgnored);
  CHECK(sequence.label_rule.classify(253) == LabelClass::kStatic);
  const DataRecord record = sequence.record();
  CHECK(record.name == "drive");
  CHECK(record.layout == "semantickitti");
  CHECK(record.source == "a test");
  CHECK(record.frames == "0:1:1");
  CHECK(record.scans == 2);
  CHECK(record.poses == "other.txt");
  CHECK(record.sensor == "hdl64e");
  CHECK(record.sensor_basis.empty());
  CHECK(record.up == "z");
  CHECK(record.up_source == "world z");
  CHECK(record.scan_period_s == 0.05);
  CHECK(record.range_m.min == 2.7);
  CHECK(record.range_m.max == 50.0);
  CHECK_FALSE(record.drop_ego);
  REQUIRE(record.label_rule);
  CHECK(record.label_rule->name == "drive");
  CHECK(record.label_rule->moving == std::vector<std::uint16_t>{252});
  CHECK(record.label_rule->ignored == std::vector<std::uint16_t>{0});
  CHECK(record.fingerprint.empty());

  SequenceOptions options;
  options.name = "mine";
  options.sensor = "estimated";
  options.poses = "poses.txt";
  options.range_m = RangeLimits{0.0, 20.0};
  options.label_rule = folder.write("rule.json", R"({"moving": [10], "ignored": [1]})");
  const Sequence over = open_sequence(folder.text(), options);
  CHECK(over.name == "mine");
  CHECK(over.scans->sensor().name == "estimated");
  CHECK(over.poses_file == "poses.txt");
  CHECK(over.range_m.max == 20.0);
  CHECK(over.label_rule.name == "rule");
  CHECK(over.label_rule.classify(10) == LabelClass::kMoving);
  CHECK(over.label_rule.classify(252) == LabelClass::kStatic);
}

TEST_CASE("sequence.json with a wrong key or value says which", "[semantickitti]") {
  const TemporaryFolder folder;
  write_sequence(folder, "", 1);
  const auto error = [&](const std::string& json) {
    folder.write("sequence.json", json);
    return open_error<ConfigurationError>(folder.text());
  };
  check_says(error(R"({"sensr": "hdl64e"})"), {"sequence.json", "'sensr'", "'sensor'"});
  check_says(error(R"({"range_m": {"mni": 1}})"), {"range_m", "'mni'", "Did you mean 'min'"});
  check_says(error(R"({"range_m": {"far": 1}})"), {"range_m", "'far'", "min, max"});
  check_says(error(R"({"range_m": {"min": 9, "max": 3}})"), {"min 9", "max 3"});
  check_says(error(R"({"range_m": {"min": -1}})"), {"range_m", "'min' is -1"});
  check_says(error(R"({"scan_period_s": "fast"})"), {"scan_period_s", "fast"});
  check_says(error(R"({"sensor": "hdl65e"})"), {"'hdl65e'", "hdl64e", "estimated"});
  check_says(error(R"({"name": "a/b"})"), {"'a/b'", "slash"});
  check_says(error(R"({"name": 5})"), {"name", "text"});
  check_says(error(R"({"poses_are_lidar": 1})"), {"poses_are_lidar", "true or false"});
  check_says(error(R"({"labels": {"moving": [1], "ignored": [1]}})"), {"both moving and ignored"});
  check_says(error("{,}"), {"sequence.json", "line 1"});
}

TEST_CASE("a path that is nothing known says what was found", "[semantickitti]") {
  const TemporaryFolder folder;
  check_says(open_error(folder.text()), {"found nothing", "Known are", "street"});
  folder.write("photo.png", "x");
  check_says(open_error(folder.text()), {"found photo.png", "velodyne"});
  check_says(open_error(folder.text() + "/photo.png"), {"is a file", "Known are"});
  check_says(open_error(folder.text() + "/none"), {"none: no such folder"});
  check_says(open_error("/none/there:05"), {"/none/there: no such folder"});
  write_sequence(folder, "", 1);
  std::filesystem::remove(folder / "velodyne/000000.bin");
  check_says(open_error(folder.text()), {"velodyne", "holds no *.bin"});
}
