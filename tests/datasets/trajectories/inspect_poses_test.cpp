// SPDX-License-Identifier: MIT
// The option that a finding on poses and times names removes the finding.
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "tests/datasets/inspect_data.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string pose_row(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += number_text(number) + " ";
  return text + "\n";
}

/// When a point of a sensor that turns clockwise from behind was taken, in seconds from the middle
/// of the scan.
float sweep_time(const Eigen::Vector3f& point, double period) {
  const double turns = 0.5 - std::atan2(point.y(), point.x()) / (2.0 * std::numbers::pi);
  return static_cast<float>((turns - std::floor(turns) - 0.5) * period);
}

/// Writes scans as x y z intensity time, each point as `stored` gives it.
void write_scans(
    const TemporaryFolder& folder, const EditedSequence& drive, double period,
    const std::function<Eigen::Vector3d(const Scan&, const Eigen::Vector3d&)>& stored) {
  for (const Scan& scan : drive.scans) {
    std::vector<float> values;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3f p = stored(scan, scan.points[i].cast<double>()).cast<float>();
      values.insert(values.end(),
                    {p.x(), p.y(), p.z(), scan.reflectance[i], sweep_time(scan.points[i], period)});
    }
    folder.write(scan.name + ".bin", floats(values));
  }
  folder.write("sequence.json", R"({"point_layout": "x y z intensity time"})");
}

Eigen::Vector3d as_seen(const Scan&, const Eigen::Vector3d& point) {
  return point;
}

/// A row of a pose file for each scan.
std::string pose_rows(const EditedSequence& drive,
                      const std::function<std::vector<double>(const Scan&)>& numbers) {
  std::string text;
  for (const Scan& scan : drive.scans) text += pose_row(numbers(scan));
  return text;
}

std::vector<double> matrix_of(const Pose& pose) {
  std::vector<double> numbers;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) numbers.push_back(pose.matrix()(r, c));
  }
  return numbers;
}

/// Time, position, and the quaternion with w first.
std::vector<double> scalar_first(const Scan& scan) {
  const Eigen::Vector3d t = scan.T_world_sensor.translation();
  const Eigen::Quaterniond q(scan.T_world_sensor.linear());
  return {0.1 * static_cast<double>(scan.index), t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()};
}

/// The word behind `option` in the remedy of the only finding.
std::string advised(const InspectionReport& report, const std::string& option) {
  REQUIRE(report.findings.size() == 1);
  const std::string& remedy = report.findings[0].remedy;
  const std::size_t at = remedy.find(option + " ");
  REQUIRE(at != std::string::npos);
  const std::string rest = remedy.substr(at + option.size() + 1);
  const std::string word = rest.substr(0, rest.find_first_of(" \n"));
  return word.substr(0, word.find_last_not_of(".,") + 1);
}

/// A street with a car that turns, with `speed` over time.
EditedSequence lively_drive(const std::string& speed) {
  const TemporaryFolder folder;
  std::string text = simulated_scene_text("suburb");
  const std::string usual = "[[0, 6], [5, 6.5], [9, 5], [14, 7]]";
  const std::size_t at = text.find(usual);
  REQUIRE(at != std::string::npos);
  text.replace(at, usual.size(), speed);
  SimulationOptions options = suburb(sparse_vlp16(), 24);
  options.scene = folder.write("lively.json", text).string();
  return EditedSequence(options);
}

/// Scans each 0.1 s, and poses whose clock is ahead of theirs by `ahead` seconds.
void write_timed(const TemporaryFolder& folder, const EditedSequence& drive, double ahead) {
  write_scans(folder, drive, 0.1, as_seen);
  std::string times;
  for (const Scan& scan : drive.scans) times += number_text(scan.time_s) + "\n";
  folder.write("times.txt", times);
  folder.write("poses.txt", pose_rows(drive, [&](const Scan& scan) {
                 const Eigen::Vector3d t = scan.T_world_sensor.translation();
                 const Eigen::Quaterniond q(scan.T_world_sensor.linear());
                 return std::vector<double>{
                     scan.time_s + ahead, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
               }));
}

/// A walk with a sensor that is mounted at `kMount`.
const EditedSequence& walk() {
  static const EditedSequence drive = [] {
    SimulationOptions options = suburb(sensor_with_step("hdl32e", "0.332"), 60);  // Every second.
    options.scene = "walk";
    options.pose_noise = 0.0;
    return EditedSequence(options);
  }();
  return drive;
}

const Pose kMount = Eigen::Translation3d(0.85, 0.2, 0.4) *
                    Eigen::AngleAxisd(90.0 * kDegree, Eigen::Vector3d::UnitZ());

std::set<std::string> found_with(const TemporaryFolder& folder, const SequenceOptions& options) {
  const InspectionReport report = inspect_path(folder.text(), options);
  INFO(text_of(report));
  return found(report);
}

}  // namespace

TEST_CASE("findings on poses go away with the option that they name", "[inspect][slow]") {
  const EditedSequence& drive = good_drive();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  folder.write("poses.txt", pose_rows(drive, [](const Scan& scan) {
                 return matrix_of(scan.T_world_sensor.inverse());
               }));
  SequenceOptions options;
  check_finds(inspect_path(folder.text(), options), "poses-inverted", "--pose-format inverse");
  options.pose_format = "inverse";
  CHECK(found_with(folder, options).empty());

  // A world in which the drive starts with another heading: else the wrong order is nearly a turn
  // of the whole world.
  EditedSequence turned = drive;
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turned.each_pose([&](const Pose& pose) { return turn * pose; });
  folder.write("poses.txt", pose_rows(turned, scalar_first));
  options.pose_format = "tum";
  check_finds(inspect_path(folder.text(), options), "quaternion-order", "--pose-format euroc");
  options.pose_format = "euroc";
  CHECK(found_with(folder, options).empty());
}

TEST_CASE("poses of a camera are no finding once it is said where the sensor is on it",
          "[inspect][slow]") {
  const EditedSequence& drive = good_drive();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  Pose T_camera_lidar = Pose::Identity();
  T_camera_lidar.matrix().topRows<3>() << 0, -1, 0, 0.05, 0, 0, -1, -0.07, 1, 0, 0, -0.27;
  folder.write("poses.txt", pose_rows(drive, [&](const Scan& scan) {
                 return matrix_of(T_camera_lidar * scan.T_world_sensor * T_camera_lidar.inverse());
               }));
  folder.write("mount.txt", pose_row(matrix_of(T_camera_lidar)));
  SequenceOptions options;
  check_finds(inspect_path(folder.text(), options), "camera-frame", "--T-sensor");
  options.T_sensor = "mount.txt";
  CHECK(found_with(folder, options).empty());
}

TEST_CASE("an array of poses beside the scans counts as none of them", "[inspect]") {
  const TemporaryFolder folder;
  for (const char* name : {"0.bin", "1.bin", "2.bin"}) folder.write(name, floats({5, 0, 0, 1}));
  const auto poses = [](std::size_t count) {
    std::string head = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                       std::to_string(count) + ", 3, 4), }";
    head.resize(117, ' ');
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
      numbers.insert(numbers.end(), {1, 0, 0, static_cast<double>(i), 0, 1, 0, 0, 0, 0, 1, 0});
    }
    return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + head + "\n" + bytes_of(numbers);
  };
  SequenceOptions options;
  options.poses = "poses.npy";
  folder.write("poses.npy", poses(3));
  CHECK(unopenable_findings(folder.text(), options).empty());
  folder.write("poses.npy", poses(4));
  const auto findings = unopenable_findings(folder.text(), options);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what == "holds 4 poses for 3 scans");
  // A file that cannot be accessed is no scan, and no finding either.
  std::filesystem::create_symlink("3.bin", folder / "3.bin");
  CHECK_THROWS_AS(unopenable_findings(folder.text(), options), UnreadableError);
}

TEST_CASE("points in the world frame are named, and brought back on request", "[inspect][slow]") {
  const EditedSequence& drive = good_drive();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, [](const Scan& scan, const Eigen::Vector3d& point) {
    return Eigen::Vector3d(scan.T_world_sensor * point);
  });
  folder.write("poses.txt",
               pose_rows(drive, [](const Scan& scan) { return matrix_of(scan.T_world_sensor); }));
  SequenceOptions options;
  check_finds(inspect_path(folder.text(), options), "points-in-world", "--points world");
  options.points = PointFrame::kWorld;
  CHECK(found_with(folder, options).empty());
}

TEST_CASE("skewed scans are no finding any more once they are deskewed", "[inspect][slow]") {
  SimulationOptions simulation = suburb(sparse_hdl64e(), 14);
  simulation.scene = "country";
  simulation.rolling = Rolling::kSkewed;
  const EditedSequence drive(simulation);
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  folder.write("poses.txt",
               pose_rows(drive, [](const Scan& scan) { return matrix_of(scan.T_world_sensor); }));
  SequenceOptions options;
  check_finds(inspect_path(folder.text(), options), "skewed-scans", "--deskew");
  options.deskew = true;
  CHECK(found_with(folder, options).empty());
}

TEST_CASE("poses of a body on which the sensor is turned are told how", "[inspect][slow]") {
  const EditedSequence& drive = good_drive();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  for (const double degrees : {90.0, 37.0, 180.0, -115.0}) {
    INFO(degrees);
    const Pose turn(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitZ()));
    folder.write("poses.txt", pose_rows(drive, [&](const Scan& scan) {
                   return matrix_of(scan.T_world_sensor * turn.inverse());
                 }));
    SequenceOptions options;
    const InspectionReport report = inspect_path(folder.text(), options);
    check_finds(report, "poses-of-a-body", "--T-sensor 0,0,0,");
    CHECK_THAT(report.findings[0].what, Catch::Contains(" degrees about z"));
    options.T_sensor = advised(report, "--T-sensor");
    CHECK(found_with(folder, options).empty());
  }
}

TEST_CASE("where a turned sensor is on its body is estimated from the turns of the body",
          "[inspect][slow]") {
  const EditedSequence& drive = walk();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  folder.write("poses.txt", pose_rows(drive, [](const Scan& scan) {
                 return matrix_of(scan.T_world_sensor * kMount.inverse());
               }));
  SequenceOptions options;
  const InspectionReport report = inspect_path(folder.text(), options);
  check_finds(report, "poses-of-a-body", "--T-sensor 0.");
  options.T_sensor = advised(report, "--T-sensor");
  CHECK(found_with(folder, options).empty());
  // Without the position, the poses do not fit.
  options.T_sensor = "0,0,0,0,0,0.70711,0.70711";
  CHECK(found_with(folder, options) == std::set<std::string>{"poses-do-not-fit"});
}

TEST_CASE("misread poses of a body are named, with and without the mount of the sensor",
          "[inspect][slow]") {
  const EditedSequence& drive = walk();
  const TemporaryFolder folder;
  write_scans(folder, drive, 0.1, as_seen);
  const auto check_both = [&](const std::string& name, const std::string& format) {
    SequenceOptions options;
    options.T_sensor = "0.85,0.2,0.4,0,0,0.70711,0.70711";
    check_finds(inspect_path(folder.text(), options), name, "--pose-format " + format);
    options.T_sensor.reset();
    const InspectionReport report = inspect_path(folder.text(), options);
    check_finds(report, name, "--pose-format " + format + " --T-sensor 0.");
    options.T_sensor = advised(report, "--T-sensor");
    options.pose_format = format;
    CHECK(found_with(folder, options).empty());
  };
  folder.write("poses.txt", pose_rows(drive, [](const Scan& scan) {
                 return matrix_of(kMount * scan.T_world_sensor.inverse());
               }));
  check_both("poses-inverted", "inverse");
  folder.write("poses.txt", pose_rows(drive, [](Scan scan) {
                 scan.T_world_sensor = scan.T_world_sensor * kMount.inverse();
                 return scalar_first(scan);
               }));
  check_both("quaternion-order", "euroc");
}

TEST_CASE("clocks that differ are told by how much, and agree once that is said",
          "[inspect][slow]") {
  const TemporaryFolder folder;
  const EditedSequence drive = lively_drive("[[0, 3], [1.2, 8], [2.4, 2]]");
  for (const double ahead : {0.12, -0.08}) {
    INFO(ahead);
    write_timed(folder, drive, ahead);
    SequenceOptions options;
    const InspectionReport report = inspect_path(folder.text(), options);
    check_finds(report, "time-offset", "--time-offset ");
    const std::string advice = advised(report, "--time-offset");
    CHECK(*parse_number<double>(advice) == Approx(ahead).margin(0.02));
    options.time_offset_s = parse_number<double>(advice);
    CHECK(found_with(folder, options).empty());
  }
  // The advice includes the user's options.
  SequenceOptions wrong;
  wrong.time_offset_s = 0.1;
  const InspectionReport report = inspect_path(folder.text(), wrong);
  CHECK(*parse_number<double>(advised(report, "--time-offset")) == Approx(-0.08).margin(0.02));
  write_timed(folder, drive, 0.0);
  CHECK(found_with(folder, {}).empty());
}
