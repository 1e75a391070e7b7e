// SPDX-License-Identifier: MIT
// Defects of files. Scans are those of a simulated drive, written in each layout.
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/inspect_data.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

namespace fs = std::filesystem;

std::string number_row(const std::vector<double>& numbers) {
  std::string row;
  for (const double number : numbers) row += (row.empty() ? "" : " ") + number_text(number);
  return row;
}

/// VIEWPOINT's seven numbers.
std::string viewpoint(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return number_row({t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()});
}

void write_pcd(const TemporaryFolder& folder, const std::string& name, const std::string& head,
               const std::vector<Eigen::Vector3f>& points, const std::vector<float>& intensity) {
  const std::string count = std::to_string(points.size());
  std::string bytes = "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\n" +
                      ("COUNT 1 1 1 1\nWIDTH " + count) + "\nHEIGHT 1\n" + head + "POINTS " +
                      count + "\nDATA binary\n";
  std::vector<float> values;
  for (std::size_t i = 0; i < points.size(); ++i) {
    values.insert(values.end(), points[i].data(), points[i].data() + 3);
    values.push_back(intensity[i]);
  }
  folder.write(name, bytes + floats(values));
}

/// How a DynamicMap folder is written; the defaults are right.
struct PcdStyle {
  int times_applied = 1;  ///< VIEWPOINT, to the points.
  std::function<Pose(const Pose&)> stored_pose = [](const Pose& pose) { return pose; };
  std::function<float(float, std::uint32_t)> intensity = [](float value, std::uint32_t) {
    return value;
  };
};

InspectionReport inspect_dynamicmap(const PcdStyle& style, const std::string& settings = "",
                                    const EditedSequence& drive = good_drive(),
                                    const SequenceOptions& options = {}) {
  const TemporaryFolder folder;
  for (const Scan& scan : drive.scans) {
    std::vector<Eigen::Vector3f> points = scan.points;
    std::vector<float> intensity;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < style.times_applied; ++k) {
        points[i] = (scan.T_world_sensor * points[i].cast<double>()).cast<float>();
      }
      intensity.push_back(style.intensity(scan.reflectance[i], drive.words[scan.index][i]));
    }
    write_pcd(folder, "pcd/" + scan.name + ".pcd",
              "VIEWPOINT " + viewpoint(style.stored_pose(scan.T_world_sensor)) + "\n", points,
              intensity);
  }
  if (!settings.empty()) folder.write("sequence.json", settings);
  return inspect_path(folder.text(), options);
}

/// A folder of .bin scans beside a pose file in the LiDAR's frame.
void write_files(const TemporaryFolder& folder, const EditedSequence& drive) {
  std::string poses;
  for (const Scan& scan : drive.scans) {
    write_cloud(folder / (scan.name + ".bin"), scan.points, scan.reflectance);
    const Eigen::Quaterniond q(scan.T_world_sensor.linear());
    const Eigen::Vector3d t = scan.T_world_sensor.translation();
    poses += number_row({scan.time_s, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) + "\n";
    folder.write("labels/" + scan.name + ".label", words(drive.words[scan.index]));
  }
  folder.write("poses.txt", poses);
  folder.write("sequence.json", R"({"range_m": {"min": 2.7}})");
}

}  // namespace

TEST_CASE("a good DynamicMap folder is silent", "[inspect]") {
  check_silent(inspect_dynamicmap({}));
}

TEST_CASE("points that lost their digits far from the origin are named", "[inspect][slow]") {
  EditedSequence far = good_drive();
  far.each_pose(
      [](const Pose& pose) { return Eigen::Translation3d(150000.0, -3000.0, 0.0) * pose; });
  check_finds(inspect_dynamicmap({}, "", far), "coordinates-coarse", "float64");
}

TEST_CASE("VIEWPOINT applied twice or not at all is named", "[inspect][slow]") {
  PcdStyle twice;
  twice.times_applied = 2;
  check_finds(inspect_dynamicmap(twice), "viewpoint-twice", "once");
  PcdStyle never;
  never.times_applied = 0;
  check_finds(inspect_dynamicmap(never), "viewpoint-missing", "--points sensor");
  SequenceOptions of_sensor;
  of_sensor.points = PointFrame::kSensor;
  check_silent(inspect_dynamicmap(never, "", good_drive(), of_sensor));
}

TEST_CASE("a VIEWPOINT that is not the sensor's pose is named", "[inspect][slow]") {
  // A sensor that looks down far enough for its blind zone to show.
  const EditedSequence drive(suburb(sparse_hdl64e(), 16));
  const std::string range = R"({"range_m": {"min": 2.7}})";
  check_silent(inspect_dynamicmap({}, range, drive));
  PcdStyle inverse;
  inverse.stored_pose = [](const Pose& pose) { return pose.inverse(); };
  check_finds(inspect_dynamicmap(inverse, range, drive), "poses-inverted", "T_world_sensor");
  PcdStyle none;  // PCL's default, points in the world frame.
  none.stored_pose = [](const Pose&) { return Pose(Pose::Identity()); };
  check_finds(inspect_dynamicmap(none, range, drive), "viewpoint-missing", "VIEWPOINT");
  // A sensor on the ground, without points below.
  none.stored_pose = [&](const Pose&) {
    return Pose(Eigen::Translation3d(0.0, 0.0, -1.8) * drive.pose(0));
  };
  check_finds(inspect_dynamicmap(none, range, drive), "viewpoint-missing", "VIEWPOINT");
}

TEST_CASE("labels in the intensity are named", "[inspect][slow]") {
  PcdStyle value;
  value.intensity = [](float, std::uint32_t word) { return static_cast<float>(word & 0xFFFFU); };
  check_finds(inspect_dynamicmap(value), "labels-in-intensity-by-value", "252, 253");
  PcdStyle moving;
  moving.intensity = [](float, std::uint32_t word) {
    return (word & 0xFFFFU) >= 50U ? 1.0F : 0.0F;
  };
  check_finds(inspect_dynamicmap(moving), "labels-in-intensity-by-value", "\"moving\": [1]");
  check_silent(inspect_dynamicmap(moving, R"({"labels": {"moving": [1]}})"));
}

TEST_CASE("a good folder of scans is silent, and labels where methods look are named",
          "[inspect][slow]") {
  EditedSequence drive = good_drive();
  const TemporaryFolder good, leaking;
  write_files(good, drive);
  check_silent(inspect_path(good.text(), {}));
  for (Scan& scan : drive.scans) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      scan.reflectance[i] = static_cast<float>(drive.words[scan.index][i] & 0xFFFFU);
    }
  }
  write_files(leaking, drive);
  check_finds(inspect_path(leaking.text(), {}), "labels-in-intensity-by-value",
              "must not get the labels");
}

TEST_CASE("a pose file with another count is named before anything is opened", "[inspect]") {
  const TemporaryFolder folder;
  write_files(folder, good_drive());
  const std::string row = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  folder.write("other.txt", row + row);
  SequenceOptions options;
  options.poses = "other.txt";
  check_finds(inspect_path(folder.text(), options), "poses-of-another-sequence",
              "--poses poses.txt");
  options.poses = "nowhere.txt";
  CHECK_THROWS_WITH(inspect_path(folder.text(), options), Catch::Contains("nowhere.txt"));
}

TEST_CASE("a gap between frames is named, and so is a time that stands", "[inspect][slow]") {
  const TemporaryFolder folder;
  write_simulated(suburb("vlp16", 12), folder / "drive", 2, nullptr);
  const std::string drive = (folder / "drive").string();
  check_silent(inspect_path(drive, {}));
  folder.write("drive/times.txt", "0\n.1\n.2\n.3\n.4\n.5\n.6\n.6\n.7\n.8\n.9\n1\n");
  check_finds(inspect_path(drive, {}), "gap-in-time", "own time");
  fs::remove(folder / "drive/times.txt");
  for (const char* name : {"000004", "000005"}) {
    fs::remove(folder / "drive/velodyne" / (std::string(name) + ".bin"));
  }
  const InspectionReport report = inspect_path(drive, {});
  check_finds(report, "gap-in-time", "missing scans");
  CHECK(report.findings[0].where == "frames 000003 to 000006");
  SequenceOptions options;  // Chosen frames have no gap where their stride is even.
  options.frames = parse_frame_range("6:11");
  check_silent(inspect_path(drive, options));
}

TEST_CASE("a file cut at a whole point is named wherever it is", "[inspect][slow]") {
  const TemporaryFolder folder;
  write_simulated(suburb("vlp16", 12), folder / "drive", 2, nullptr);
  fs::remove_all(folder / "drive/labels");
  const auto path = folder / "drive/velodyne/000010.bin";
  fs::resize_file(path, fs::file_size(path) / 32 * 16);
  const InspectionReport report = inspect_path((folder / "drive").string(), {});
  check_finds(report, "few-points", "Copy the scan again");
  CHECK(report.findings[0].where == "000010.bin");
  CHECK_THAT(report.findings[0].what, Catch::Contains("50 % of what the scans around it hold"));
}

TEST_CASE("missing returns in files are a note, and nothing has to be done", "[inspect][slow]") {
  const float nan = std::nanf("");
  for (const Eigen::Vector3f& fake : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(nan, nan, nan)}) {
    EditedSequence drive = good_drive();
    for (Scan& scan : drive.scans) {
      for (std::size_t i = 0; i < scan.size(); i += 10) scan.points[i] = fake;
    }
    const TemporaryFolder folder;
    write_files(folder, drive);
    const InspectionReport report = inspect_path(folder.text(), {});
    INFO(text_of(report));
    REQUIRE(report.findings.size() == 1);
    CHECK_FALSE(report.has_findings());
    CHECK(report.findings[0].check == "left-out");
    CHECK_THAT(report.findings[0].what, Catch::Contains("10.0 % of the stored points"));
  }
}

TEST_CASE("copied files are named wherever they are", "[inspect]") {
  const TemporaryFolder folder;
  write_files(folder, good_drive());
  for (const char* name : {"000011.bin", "labels/000011.label"}) {
    const std::string source = std::string(name).replace(std::string(name).find("11"), 2, "02");
    fs::copy_file(folder / source, folder / name, fs::copy_options::overwrite_existing);
  }
  const InspectionReport report = inspect_path(folder.text(), {});
  INFO(text_of(report));
  REQUIRE(found(report).count("duplicated-scans") == 1);
  CHECK(report.findings[0].where == "000011.bin");
  CHECK_THAT(report.findings[0].what, Catch::Contains("000002.bin"));
}

TEST_CASE("cleaning refuses what makes the map wrong, and does not mind labels", "[inspect]") {
  std::set<std::string> refused, unused;
  for (const InspectionCheck& check : inspection_checks()) {
    if (check.consequence == Consequence::kRefused) refused.insert(check.name);
    if (check.consequence == Consequence::kUnused) unused.insert(check.name);
  }
  CHECK(refused ==
        std::set<std::string>{"points-in-millimetres", "poses-inverted", "camera-frame",
                              "lidar-poses-as-camera", "quaternion-order", "poses-in-millimetres",
                              "poses-coarse", "viewpoint-twice", "viewpoint-missing",
                              "sensor-elsewhere", "points-in-world", "poses-do-not-fit",
                              "beams-start-elsewhere", "poses-shifted", "poses-of-another-sequence",
                              "poses-of-a-body", "poses-of-another-time", "motion-uncertain"});
  CHECK(unused ==
        std::set<std::string>{"labels-shifted", "label-count", "labels-in-intensity-by-value"});
}

TEST_CASE("each check has a name of its own, a sentence and a remedy", "[inspect]") {
  std::set<std::string> names;
  for (const InspectionCheck& check : inspection_checks()) {
    CHECK(names.insert(check.name).second);
    CHECK_FALSE(check.finds.empty());
    CHECK_FALSE(check.remedy.empty());
  }
}
