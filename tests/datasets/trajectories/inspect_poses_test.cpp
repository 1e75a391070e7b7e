// SPDX-License-Identifier: MIT
// What inspection finds in poses and times goes away with the option that it names.
#include <cmath>
#include <numbers>

#include "core/text.h"
#include "datasets/inspection/unopenable.h"
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

std::set<std::string> found_with(const TemporaryFolder& folder, const SequenceOptions& options) {
  const InspectionReport report = inspect_path(folder.text(), options);
  INFO(text_of(report));
  return found(report);
}

}  // namespace

TEST_CASE("findings on poses go away with the option that they name", "[inspect][every-finding]") {
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
          "[inspect]") {
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
  CHECK(inspection::unopenable_findings(folder.text(), options).empty());
  folder.write("poses.npy", poses(4));
  const auto findings = inspection::unopenable_findings(folder.text(), options);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what == "holds 4 poses for 3 scans");
}

TEST_CASE("points in the world frame are named, and brought back on request",
          "[inspect][every-finding]") {
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

TEST_CASE("skewed scans are no finding any more once they are deskewed", "[inspect]") {
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
