// SPDX-License-Identifier: MIT
// Pose files of every form, times, the place of a sensor on a body, and times of points.
#include <cmath>
#include <cstring>

#include "datasets/deskew/deskew.h"
#include "datasets/trajectories/body_sensor.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

void check_poses(const PoseFile& file) {
  require(!file.rows.empty(), "a pose file without poses is let through");
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    require(file.rows[i].stamp.has_value() == file.stamped(), "some poses have times, some none");
    require(file.rows[i].frame.has_value() == file.rows[0].frame.has_value(),
            "some poses have frames, some none");
    require(i == 0 || !file.stamped() || *file.rows[i].stamp >= *file.rows[i - 1].stamp,
            "times of poses run backwards");
  }
  std::vector<std::string> notes;
  if (file.stamped()) may_refuse([&] { (void)Trajectory(stamped_poses(file, notes)); });
}

/// The first byte chooses a format that the user says, or none, and the name of the file.
RAYMOVAL_FUZZ_TARGET(pose_formats) {
  static const std::vector<PoseFormatName> names = pose_format_names();
  if (bytes.empty()) return;
  const auto choice = static_cast<unsigned char>(bytes.front());
  const std::size_t at = choice % (names.size() + 2);
  PoseReading reading;
  if (at < names.size()) reading.format = names[at].name;
  if (at == names.size()) reading.format = "inverse";
  const char* file = choice < 128 ? "poses.txt" : "poses.json";
  may_refuse([&] { check_poses(read_pose_file(input_file(file, bytes.substr(1)), reading)); });
}

RAYMOVAL_FUZZ_TARGET(stamps) {
  for (const TimeUnit unit : {TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kMicroseconds,
                              TimeUnit::kNanoseconds}) {
    const auto stamp = parse_stamp(bytes, unit);
    if (!stamp) continue;
    require(std::abs(*stamp) <= kMostStamp, "a time is too far");
    require(parse_stamp(stamp_text(*stamp)) == *stamp, "a time changes when written and read");
  }
  const std::size_t middle = bytes.size() / 2;
  const auto named =
      stamps_in_names({std::string(bytes.substr(0, middle)), std::string(bytes.substr(middle))});
  require(!named || named->stamps[0] != named->stamps[1], "two names give one time");
}

RAYMOVAL_FUZZ_TARGET(T_sensor) {
  const std::string text(bytes.substr(0, bytes.find('\0')));  // As a command line has it.
  const auto check = [](const BodySensor& sensor) {
    const Eigen::Matrix3d rotation = sensor.T_body_sensor.linear();
    require((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 1e-9,
            "the place of a sensor is not rigid");
  };
  const auto path = input_file("T.txt", bytes);
  may_refuse([&] { check(read_body_sensor(path.string(), {})); });
  if (text.find('/') == std::string::npos && text.size() < 200) {
    may_refuse([&] { check(read_body_sensor(text, path.parent_path())); });
  }
}

/// The first byte is the type of the times, the second says which unit the user names; the rest are
/// the times of two scans.
RAYMOVAL_FUZZ_TARGET(point_times) {
  if (bytes.size() < 2) return;
  const std::pair<char, int> types[] = {{'F', 4}, {'F', 8}, {'U', 2}, {'U', 4}, {'U', 8}, {'I', 8}};
  const auto [type, size] = types[static_cast<unsigned char>(bytes[0]) % 6];
  const std::optional<std::string> units[] = {std::nullopt, "ns", "s", "1e-5"};
  const std::string_view data = bytes.substr(2);
  std::vector<TimedScan> scans(2);
  for (std::size_t k = 0; k < 2; ++k) {
    TimedScan& timed = scans[k];
    timed.place = "scan";
    timed.stamp = static_cast<Nanoseconds>(k) * 100'000'000;
    timed.records.layout.add("t", type, size);
    const std::size_t row = timed.records.layout.row_bytes, half = data.size() / 2 / row;
    timed.records.bytes.resize(half * row);
    std::memcpy(timed.records.bytes.data(), data.data() + k * half * row, half * row);
    timed.scan.points.assign(half, Eigen::Vector3f::Ones());
  }
  if (scans.front().scan.points.empty()) return;
  may_refuse([&] {
    const PointClock clock =
        find_point_clock(scans, units[static_cast<unsigned char>(bytes[1]) % 4]);
    for (const TimedScan& timed : scans) {
      for (const double time : point_times(timed, clock)) {
        require(std::abs(time) < 10.0, "a point is far from its scan");
      }
    }
  });
}

}  // namespace
}  // namespace raymoval::fuzz
