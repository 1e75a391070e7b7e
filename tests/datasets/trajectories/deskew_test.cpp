// SPDX-License-Identifier: MIT
// A car drives at 10 m/s towards a wall at x = 100 and turns while it does; a scan takes 0.1 s.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "datasets/ego/ego_region.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

constexpr double kSpeed = 10.0, kTurning = -0.2, kPeriod = 0.1, kWall = 100.0;
constexpr int kScans = 5, kPoints = 50;
constexpr double kStart = 1600000000.0;

Pose pose_at(double seconds) {
  Pose pose = Pose::Identity();
  pose.translation().x() = kSpeed * seconds;
  pose.linear() =
      Eigen::AngleAxisd(kTurning * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// How the points of a drive are stored.
struct Drive {
  std::string type = "F", size = "4";
  double unit = 1.0;    ///< Of a point's time, seconds.
  double zero = 0.0;    ///< When the scan has its time, seconds after its first point.
  double clock = -1.0;  ///< What the times of points count from; -1: the time of the scan.
  std::string field = "time";
  int poses = kScans;  ///< One a scan, from the first on.
  bool times = true;   ///< Whether scans have times.
};

std::string row(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += number_text(number) + " ";
  return text + "\n";
}

void write_drive(const TemporaryFolder& folder, const Drive& drive) {
  std::string times, poses;
  for (int i = 0; i < kScans; ++i) {
    const double begin = kPeriod * i, stamp = begin + drive.zero;
    times += stamp_text(from_seconds(kStart) + from_seconds(stamp)) + "\n";
    std::string points;
    for (int k = 0; k < kPoints; ++k) {
      const double time = begin + kPeriod * k / kPoints;
      const Eigen::Vector3d point = pose_at(time).inverse() * Eigen::Vector3d(kWall, k - 25.0, 1.0);
      const double told = drive.clock < 0.0 ? time - stamp : time + drive.clock;
      const bool whole = drive.type != "F";
      const double units = told / drive.unit;
      points += row({point.x(), point.y(), point.z(), whole ? std::round(units) : units});
    }
    const std::string count = std::to_string(kPoints);
    folder.write(std::to_string(i) + ".pcd",
                 "VERSION 0.7\nFIELDS x y z " + drive.field + "\nSIZE 4 4 4 " + drive.size +
                     "\nTYPE F F F " + drive.type + "\nCOUNT 1 1 1 1\nWIDTH " + count +
                     "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + points);
  }
  for (int i = 0; i < drive.poses; ++i) {
    const double stamp = kPeriod * i + drive.zero;
    const Eigen::Quaterniond q(pose_at(stamp).linear());
    const std::string pose =
        row({pose_at(stamp).translation().x(), 0, 0, q.x(), q.y(), q.z(), q.w()});
    poses += stamp_text(from_seconds(kStart) + from_seconds(stamp)) + " " + pose;
  }
  if (drive.times) folder.write("times.txt", times);
  folder.write("poses.txt", poses);
}

/// The largest distance of a point from the wall, metres.
double error_of(const Sequence& sequence) {
  double error = 0.0;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const Scan scan = sequence.scans->load(i);
    for (const Eigen::Vector3f& point : scan.points) {
      error = std::max(error, std::abs((scan.T_world_sensor * point.cast<double>()).x() - kWall));
    }
  }
  return error;
}

Sequence opened(const TemporaryFolder& folder, const std::optional<std::string>& unit = {}) {
  SequenceOptions options;
  options.deskew = true;
  options.point_time_unit = unit;
  return open_sequence(folder.text(), options);
}

double deskewed_error(const Drive& drive) {
  const TemporaryFolder folder;
  write_drive(folder, drive);
  return error_of(opened(folder));
}

}  // namespace

TEST_CASE("a wall that motion within scans smears is one again", "[deskew]") {
  const TemporaryFolder folder;
  write_drive(folder, {});
  CHECK(error_of(open_sequence(folder.text(), {})) > 0.9);
  const Sequence sequence = opened(folder);
  CHECK(error_of(sequence) < 1e-3);
  REQUIRE(sequence.notes.size() == 2);
  check_says(sequence.notes[0], {"'time'", "seconds from the time of the scan"});
  check_says(sequence.notes[1], {"after the last pose"});  // The last scan ends behind it.
  // Records, poses and the files of the scans are unchanged.
  CHECK(sequence.records->records(0).size() == kPoints);
  CHECK(file_source(sequence) != nullptr);
}

TEST_CASE("times of points are read in any unit and from any zero", "[deskew]") {
  for (const auto& [unit, type, size] : {std::tuple(1e-3, "F", "4"), std::tuple(1e-6, "U", "4"),
                                         std::tuple(1e-9, "U", "4"), std::tuple(1e-9, "F", "8")}) {
    INFO(unit << type << size);
    CHECK(deskewed_error({.type = type, .size = size, .unit = unit}) < 1e-3);
  }
  // From the end, and from the middle of the scan.
  CHECK(deskewed_error({.zero = kPeriod}) < 1e-3);
  CHECK(deskewed_error({.zero = 0.5 * kPeriod, .field = "timestamp"}) < 1e-3);
  // Seconds since 1970, on the clock of the scans.
  CHECK(deskewed_error({.size = "8", .clock = kStart, .field = "timestamp"}) < 1e-3);
  // Seconds since the start of the sensor, which nothing else counts from.
  CHECK(deskewed_error({.size = "8", .clock = 4321.0}) < 1e-3);
}

TEST_CASE("times that cannot be used are errors that say why", "[deskew]") {
  const TemporaryFolder folder;
  const auto error = [&](const Drive& drive) {
    write_drive(folder, drive);
    return message_of<DataError>([&] { opened(folder); });
  };
  check_says(error({.field = "ring"}), {"0.pcd: --deskew needs the time", "found x, y, z, ring"});
  check_says(error({.size = "8", .unit = 1e5}), {"is not a time of a scan", "--point-time-unit"});
  check_says(error({.clock = kStart}), {"0.pcd", "same time"});  // Float32: all are one.
  write_drive(folder, {.type = "U", .unit = 1e-5});
  CHECK(error_of(opened(folder, "1e-5")) < 1e-3);
  check_says(message_of<UsageError>([&] { opened(folder, "minutes"); }),
             {"--point-time-unit minutes", "s, ms, us, ns"});
  check_says(message_of<UsageError>([] {
               SequenceOptions options;
               options.deskew = true;
               open_sequence("street", options);
             }),
             {"--deskew cannot be used"});
}
