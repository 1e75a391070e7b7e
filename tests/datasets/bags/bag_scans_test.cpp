// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "core/error.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "tests/datasets/bags/message_bytes.h"
#include "tests/datasets/bags/ros1_writer.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {
namespace {

const std::vector<double> kAtOrigin = {0, 0, 0, 0, 0, 0, 1};

MessageBytes ros1() {
  return MessageBytes(MessageEncoding::kRos1);
}

/// A motion to (x, y, z) without a turn.
std::vector<double> shift(double x, double y = 0, double z = 0) {
  return {x, y, z, 0, 0, 0, 1};
}

/// A ROS 1 bag that is made message by message. Each message is recorded 5 s after its stamp, so
/// that a confusion of both times is detected.
class MadeBag {
 public:
  explicit MadeBag(std::filesystem::path path) : path_(std::move(path)) {}
  void add(const std::string& topic, const std::string& type, double seconds,
           const std::string& message) {
    const auto id = static_cast<std::uint32_t>(std::find(topics_.begin(), topics_.end(), topic) -
                                               topics_.begin());
    if (id == topics_.size()) topics_.push_back(topic);
    writer_.message(id, topic, type, "", from_seconds(seconds + 5), message);
  }
  /// Two points, (10, y, 1) with `y` = 1000 * the time, and one without a return.
  void cloud(double seconds, const std::string& frame = "lidar",
             const std::string& topic = "/points") {
    CloudHead head;
    std::tie(head.seconds, head.nanoseconds) = stamp_of(seconds);
    head.frame = frame;
    head.width = 2;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    add(topic, "sensor_msgs/PointCloud2", seconds,
        cloud_message(ros1(), head, floats({10, static_cast<float>(seconds), 1, nan, nan, nan})));
  }
  void odometry(double seconds, const std::vector<double>& motion,
                const std::string& child = "lidar", const std::string& topic = "/odom") {
    const auto [whole, part] = stamp_of(seconds);
    add(topic, "nav_msgs/Odometry", seconds,
        ros1().header(whole, part, "odom").text(child).motion(motion).bytes());
  }
  void tf(double seconds, const std::string& parent, const std::string& child,
          const std::vector<double>& motion, const std::string& topic = "/tf") {
    const auto [whole, part] = stamp_of(seconds);
    MessageBytes message = ros1();
    message.u32(1).header(whole, part, parent).text(child).motion(motion);
    add(topic, "tf2_msgs/TFMessage", seconds, message.bytes());
  }
  std::string finish() {
    std::ofstream(path_, std::ios::binary) << writer_.finish();
    return path_.string();
  }

 private:
  static std::pair<std::uint32_t, std::uint32_t> stamp_of(double seconds) {
    const Nanoseconds stamp = from_seconds(seconds);
    return {static_cast<std::uint32_t>(stamp / 1'000'000'000),
            static_cast<std::uint32_t>(stamp % 1'000'000'000)};
  }
  std::filesystem::path path_;
  Ros1Writer writer_{Ros1Compression::kLz4};
  std::vector<std::string> topics_;
};

/// Four clouds from 100.1 s on, each 0.2 s later than the one before.
void add_clouds(MadeBag& bag, const std::string& frame = "lidar") {
  for (int i = 0; i < 4; ++i) bag.cloud(100.1 + 0.2 * i, frame);
}

/// drive.bag: four clouds from 100.1 s on, and the odometry of 10 m along x from 100 to 101 s.
/// @return its path
std::string straight_drive(const TemporaryFolder& folder) {
  MadeBag bag(folder / "drive.bag");
  bag.odometry(100, shift(0));
  add_clouds(bag);
  bag.odometry(101, shift(10));
  return bag.finish();
}

Eigen::Vector3d position(const Sequence& sequence, std::size_t scan) {
  return sequence.scans->pose(scan).translation();
}

std::string usage_error(const std::string& path, const SequenceOptions& options = {}) {
  return message_of<UsageError>([&] { (void)open_sequence(path, options); });
}

std::string notes_of(const Sequence& sequence) {
  return join(sequence.notes, "\n");
}

TEST_CASE("A bag is a sequence: its clouds at the poses of its odometry", "[bags]") {
  const TemporaryFolder folder;
  const Sequence sequence = open_sequence(straight_drive(folder), {});
  CHECK(sequence.name == "drive");
  CHECK(sequence.layout == "bags");
  CHECK(sequence.frames == "0:3:1");
  CHECK(sequence.poses_file == "/odom");
  REQUIRE(sequence.scans->size() == 4);
  // Between the poses, by the stamps of the messages and not by the time of recording.
  CHECK(position(sequence, 0).isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
  CHECK(position(sequence, 3).isApprox(Eigen::Vector3d(7, 0, 0), 1e-9));
  const Scan scan = sequence.scans->load(2);
  CHECK(scan.name == "000002");
  CHECK(scan.time_s == Approx(0.4));
  REQUIRE(scan.size() == 1);  // The other point is no return.
  CHECK(scan.points[0] == Eigen::Vector3f(10, 100.5F, 1));
  CHECK(scan.stored_point_count == 2);
  CHECK(sequence.records->records(2).size() == 2);
  CHECK(sequence.records->layout(2) == sequence.records->records(2).layout);
  CHECK(sequence.records->place(2) == "drive.bag: /points, message 2");
  CHECK(sequence.records->point_frame() == PointFrame::kSensor);
  REQUIRE(sequence.motion != nullptr);
  CHECK(sequence.motion->at(from_seconds(100.2))->translation().x() == Approx(2));
  CHECK(sequence.stamps.at(1) == from_seconds(100.3));
  check_says(notes_of(sequence), {"/points (sensor_msgs/PointCloud2, 4 messages)", "/odom"});
}

TEST_CASE("A file of indices beside a bag labels some of its scans", "[bags]") {
  const TemporaryFolder folder;
  const std::string path = straight_drive(folder);
  // Scans 1 and 2; a scan that is not there; blanks, a comma at the end, and an empty line.
  folder.write("indices.csv", "100300000000,0\n\n100500000000, \r\n999000000000,0,1,\n");
  const Sequence sequence = open_sequence(path, {});
  REQUIRE(sequence.labels);
  const auto labels = [&](std::size_t scan) {
    return sequence.labels->labels(sequence.scans->load(scan));
  };
  CHECK(labels(0) == std::vector<std::uint32_t>{0});
  CHECK(labels(1) == std::vector<std::uint32_t>{251});
  CHECK(labels(2) == std::vector<std::uint32_t>{9});
  CHECK(sequence.label_rule.classify(251) == LabelClass::kMoving);
  CHECK(sequence.label_rule.classify(0) == LabelClass::kIgnored);
  check_says(notes_of(sequence), {"2 of 4 scans are labelled", "1 line of it"});
}

TEST_CASE("A file of indices that is damaged is an error", "[bags]") {
  const TemporaryFolder folder;
  const std::string path = straight_drive(folder);
  const auto error = [&](const std::string& lines) {
    folder.write("indices.csv", lines);
    return message_of<DataError>([&] {
      const Sequence sequence = open_sequence(path, {});
      (void)sequence.labels->labels(sequence.scans->load(1));
    });
  };
  check_says(error("time,0\n"), {"line 1", "'time' is not a time", "nanoseconds"});
  check_says(error("100300000000,0,-1\n"), {"line 1, field 3", "'-1'"});
  check_says(error("100300000000,0 1\n"), {"line 1, field 2", "'0 1'"});
  check_says(error("100300000000,0\n100300000000,1\n"), {"line 2", "time of line 1 again"});
  // Point 1, a missing return, exists; point 2 does not.
  check_says(error("100300000000,1,2\n"), {"line 1", "point 2 of a scan of 2"});
}

TEST_CASE("By no label rule is a scan without indices scored", "[bags]") {
  const TemporaryFolder folder;
  const std::string path = straight_drive(folder);
  folder.write("indices.csv", "100300000000,0\n");
  SequenceOptions options;
  options.label_rule = folder / "rule.json";
  for (const char* rule : {R"({"moving": [251]})", R"({"moving": [251], "ignored": []})",
                           R"({"moving": [251], "ignored": [0, 9]})"}) {
    folder.write("rule.json", rule);
    const Sequence sequence = open_sequence(path, options);
    CHECK(sequence.label_rule.name == "rule");
    CHECK(sequence.label_rule.classify(0) == LabelClass::kIgnored);
    CHECK(sequence.label_rule.classify(251) == LabelClass::kMoving);
    CHECK(sequence.label_rule.ignored.front() == 0);
    CHECK(std::count(sequence.label_rule.ignored.begin(), sequence.label_rule.ignored.end(), 0) ==
          1);
  }
  folder.write("rule.json", R"({"moving": [0, 251]})");
  check_says(message_of<ConfigurationError>([&] { (void)open_sequence(path, options); }),
             {"'rule'", "label id 0", "scans without labels"});
}

TEST_CASE("Poses of another frame go on by tf_static, also one that comes late", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  // The body turns from 0 to 90 degrees to the left; the sensor is 2 m ahead of it.
  bag.odometry(100, kAtOrigin, "base");
  add_clouds(bag);
  bag.odometry(100.2, {0, 0, 0, 0, 0, std::sqrt(0.5), std::sqrt(0.5)}, "base");
  bag.odometry(101, {0, 0, 0, 0, 0, std::sqrt(0.5), std::sqrt(0.5)}, "base");
  bag.tf(200, "base", "mount", shift(1.5), "/tf_static");
  bag.tf(200, "mount", "/lidar", shift(0.5), "/tf_static");
  const Sequence sequence = open_sequence(bag.finish(), {});
  const double half = std::sqrt(2.0);
  CHECK(position(sequence, 0).isApprox(Eigen::Vector3d(half, half, 0), 1e-9));
  CHECK(position(sequence, 1).isApprox(Eigen::Vector3d(0, 2, 0), 1e-9));
  check_says(notes_of(sequence), {"'base'", "'lidar'", "taken from tf"});
}

TEST_CASE("Without odometry the frames of tf are followed from the root to the sensor", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  bag.tf(0, "base", "lidar", shift(0, 0, 2), "/tf_static");
  // The map corrects the odometry slowly; each step is interpolated on its own.
  bag.tf(99, "map", "odom", shift(0, 10));
  bag.tf(100, "odom", "base", shift(0));
  bag.tf(100, "base", "wheel", shift(7));
  add_clouds(bag);
  bag.tf(101, "odom", "base", shift(10));
  bag.tf(101, "map", "odom", shift(0, 14));
  bag.tf(101, "odom", "base", shift(10));  // What several publishers say twice counts once.
  SequenceOptions options;
  options.max_gap_s = 5;
  const Sequence sequence = open_sequence(bag.finish(), options);
  CHECK(sequence.poses_file == "tf map -> lidar");
  CHECK(position(sequence, 0).isApprox(Eigen::Vector3d(1, 12.2, 2), 1e-9));
  CHECK(sequence.motion->span().first == from_seconds(100));
  // Only `base` is fixed to the frame of the points; `wheel` may move.
  const auto frames = sequence.fixed_frames();
  CHECK(frames.size() == 1);
  CHECK(frames.at("base").isApprox(Eigen::Vector3d(0, 0, -2)));
}

TEST_CASE("A step of tf has a pose only where messages give one", "[bags]") {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto data_error_of = [](MadeBag& bag) {
    const std::string path = bag.finish();
    return message_of<DataError>([&] { (void)open_sequence(path, {}); });
  };
  {
    // A filter that diverged: its poses are not replaced.
    MadeBag bag(folder / "diverged.bag");
    bag.tf(0, "base", "lidar", shift(0, 0, 2), "/tf_static");
    bag.tf(100, "odom", "base", shift(nan));
    add_clouds(bag);
    bag.tf(101, "odom", "base", shift(nan));
    check_says(data_error_of(bag), {"diverged.bag: tf", "no pose of frame base in odom",
                                    "not a rigid motion", "--pose-topic", "--poses"});
  }
  {
    // One unusable message of four is reported as a loss, also with the result.
    MadeBag bag(folder / "once.bag");
    bag.tf(100, "odom", "lidar", shift(0));
    bag.tf(100.3, "odom", "lidar", shift(nan));
    add_clouds(bag);
    bag.tf(101, "odom", "lidar", shift(10));
    const Sequence sequence = open_sequence(bag.finish(), {});
    CHECK(position(sequence, 1).isApprox(Eigen::Vector3d(3, 0, 0), 1e-9));
    REQUIRE(sequence.losses.size() == 1);
    check_says(sequence.losses[0],
               {"once.bag: tf: 1 message could not be used", "not a rigid motion"});
    CHECK(sequence.record().losses == sequence.losses);
  }
  {
    // A single message says nothing of other times, also if the frame never moves.
    MadeBag bag(folder / "single.bag");
    bag.tf(99, "map", "odom", shift(0, 10));
    bag.tf(100, "odom", "lidar", shift(0));
    add_clouds(bag);
    bag.tf(101, "odom", "lidar", shift(10));
    check_says(data_error_of(bag), {"single.bag: tf map -> lidar"});
  }
  {
    // Nor do two that are further apart than the greatest gap.
    MadeBag bag(folder / "gap.bag");
    bag.tf(99, "map", "odom", shift(0, 10));
    bag.tf(105, "map", "odom", shift(0, 10));
    bag.tf(100, "odom", "lidar", shift(0));
    add_clouds(bag);
    bag.tf(101, "odom", "lidar", shift(10));
    check_says(data_error_of(bag), {"gap.bag: tf map -> lidar"});
    SequenceOptions options;
    options.max_gap_s = 6;
    const Sequence sequence = open_sequence((folder / "gap.bag").string(), options);
    CHECK(position(sequence, 0).isApprox(Eigen::Vector3d(1, 10, 0), 1e-9));
  }
}

TEST_CASE("A bag without poses names what there is, and ways to poses", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  add_clouds(bag);
  bag.tf(0, "base", "lidar", shift(0, 0, 2), "/tf_static");
  const std::string path = bag.finish();
  check_says(usage_error(path), {"drive.bag: there are no poses", "fixed transform",
                                 "/points (sensor_msgs/PointCloud2", "--pose-topic", "KISS-ICP",
                                 "GLIM", "FAST-LIO", "docs/poses.md", "identity"});
  SequenceOptions options;
  options.poses = "identity";
  const Sequence sequence = open_sequence(path, options);
  CHECK(position(sequence, 3).isZero());
  // A trajectory of another program, by time.
  options.poses = folder.write("traj.txt", "100 0 0 0 0 0 0 1\n101 10 0 0 0 0 0 1\n").string();
  const Sequence by_time = open_sequence(path, options);
  CHECK(position(by_time, 1).isApprox(Eigen::Vector3d(3, 0, 0), 1e-9));
  CHECK(by_time.poses_file == "traj.txt");
  REQUIRE(by_time.input_files.size() == 2);
  CHECK(by_time.input_files[0] == path);
}

TEST_CASE("Of several topics of a kind one is to be named", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  bag.odometry(100, shift(0), "lidar", "/a");
  bag.odometry(100, shift(1), "lidar", "/b");
  add_clouds(bag);
  bag.cloud(100.5, "rear", "/rear_points");
  bag.odometry(101, shift(10), "lidar", "/a");
  bag.odometry(101, shift(11), "lidar", "/b");
  const std::string path = bag.finish();
  check_says(usage_error(path), {"/points (", "/rear_points (", "--topic"});
  SequenceOptions options;
  options.topic = "/poinst";
  check_says(usage_error(path, options), {"--topic /poinst", "Did you mean '/points'?"});
  options.topic = "/a";
  check_says(usage_error(path, options), {"no topic with scans", "nav_msgs/Odometry"});
  options.topic = "points";
  check_says(usage_error(path, options), {"/a (", "/b (", "--pose-topic"});
  options.pose_topic = "/b";
  CHECK(position(open_sequence(path, options), 0).isApprox(Eigen::Vector3d(2, 0, 0), 1e-9));
}

/// Four clouds of each of two sensors, the rear one 50 ms later and 2 m behind, if tf has its
/// place.
std::string two_sensors(const TemporaryFolder& folder, const std::string& rear_frame = "rear",
                        bool has_place = true) {
  MadeBag bag(folder / "two.bag");
  bag.odometry(100, shift(0), "front");
  if (has_place) bag.tf(100, "front", "rear", shift(-2, 0, 0.5), "/tf_static");
  for (int i = 0; i < 4; ++i) bag.cloud(100.1 + 0.2 * i, "front", "/a");
  for (int i = 0; i < 4; ++i) bag.cloud(100.15 + 0.2 * i, rear_frame, "/b");
  bag.odometry(101, shift(10), "front");
  return bag.finish();
}

TEST_CASE("Several topics are the scans of several sensors, in order of time", "[bags]") {
  const TemporaryFolder folder;
  const std::string path = two_sensors(folder);
  check_says(usage_error(path), {"several topics", "--topic /a,/b"});
  SequenceOptions options;
  options.topic = "/a,b";
  const Sequence sequence = open_sequence(path, options);
  REQUIRE(sequence.scans->size() == 8);
  CHECK(sequence.topics == std::vector<std::size_t>{0, 1, 0, 1, 0, 1, 0, 1});
  CHECK(position(sequence, 2).isApprox(Eigen::Vector3d(3, 0, 0), 1e-9));
  CHECK(position(sequence, 3).isApprox(Eigen::Vector3d(1.5, 0, 0.5), 1e-9));
  CHECK(sequence.stamps.at(3) == from_seconds(100.35));
  const Scan scan = sequence.scans->load(3);
  CHECK(scan.name == "000003");
  CHECK(scan.time_s == Approx(0.25));
  CHECK(scan.points.at(0) == Eigen::Vector3f(10, 100.35F, 1));
  CHECK(sequence.records->place(3) == "two.bag: /b, message 1");
  options.frames = parse_frame_range("::2");  // Of each topic.
  CHECK(open_sequence(path, options).topics == std::vector<std::size_t>{0, 1, 0, 1});
  options.topic = "/a,/a";
  check_says(usage_error(path, options), {"names /a twice"});
}

TEST_CASE("Several topics need the place of each sensor", "[bags]") {
  const TemporaryFolder folder;
  SequenceOptions options;
  options.topic = "/a,/b";
  check_says(usage_error(two_sensors(folder, "rear", false), options),
             {"no transform between 'front' and 'rear'", "one by one"});
  const std::string path = two_sensors(folder, "front");
  check_says(usage_error(path, options), {"are in one frame, 'front'", "topic:0=X,Y,Z/1=X,Y,Z"});
  options.sensor_origin = parse_sensor_places("1,0,0");
  check_says(usage_error(path, options), {"no place of topic 0", "topic:0=X,Y,Z/1=X,Y,Z"});
  options.sensor_origin = parse_sensor_places("topic:0=1,0,0/1=-1,0,0.5");
  const Sequence sequence = open_sequence(path, options);
  CHECK(position(sequence, 0).isApprox(Eigen::Vector3d(2, 0, 0), 1e-9));
  CHECK(position(sequence, 1).isApprox(Eigen::Vector3d(0.5, 0, 0.5), 1e-9));
  CHECK(sequence.scans->load(1).points.at(0) == Eigen::Vector3f(11, 100.15F, 0.5F));
}

TEST_CASE("Frames that do not fit are errors that name them", "[bags]") {
  const TemporaryFolder folder;
  SequenceOptions options;
  {
    MadeBag bag(folder / "unknown.bag");
    bag.odometry(100, shift(0), "base");
    add_clouds(bag);
    bag.odometry(101, shift(10), "base");
    const std::string path = bag.finish();
    check_says(usage_error(path), {"/odom", "'base'", "'lidar'", "--T-sensor"});
    options.T_sensor = "0,0,3,0,0,0,1";
    CHECK(position(open_sequence(path, options), 0).isApprox(Eigen::Vector3d(1, 0, 3), 1e-9));
  }
  const auto data_error = [](const std::string& path) {
    return message_of<DataError>([&] { (void)open_sequence(path, {}); });
  };
  {
    MadeBag bag(folder / "mixed.bag");
    bag.odometry(100, shift(0), "lidar");
    bag.odometry(101, shift(1), "base");
    add_clouds(bag);
    check_says(data_error(bag.finish()), {"/odom, message 1", "'base'", "'lidar'"});
  }
  {
    MadeBag bag(folder / "clouds.bag");
    add_clouds(bag);
    bag.cloud(100.9, "other");
    check_says(data_error(bag.finish()), {"/points, message 4", "'other'", "'lidar'"});
  }
  {
    MadeBag bag(folder / "parents.bag");
    bag.tf(100, "odom", "lidar", shift(0));
    bag.tf(100, "map", "lidar", shift(0));
    add_clouds(bag);
    check_says(data_error(bag.finish()), {"frame lidar", "odom", "map", "two parents"});
  }
  {
    MadeBag bag(folder / "circle.bag");
    bag.tf(100, "odom", "lidar", shift(0));
    bag.tf(100, "lidar", "odom", shift(0));
    add_clouds(bag);
    check_says(data_error(bag.finish()), {"its own ancestor"});
  }
}

TEST_CASE("Scans without a pose, and messages without a point, are left out and said", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  bag.odometry(100.2, shift(0));
  add_clouds(bag);
  bag.add("/points", "sensor_msgs/PointCloud2", 100.8, cloud_message(ros1(), CloudHead{}, ""));
  bag.add("/points", "sensor_msgs/PointCloud2", 100.9, "damaged");
  bag.cloud(100.95);
  bag.odometry(101, shift(10));
  const Sequence sequence = open_sequence(bag.finish(), {});
  REQUIRE(sequence.scans->size() == 4);
  CHECK(sequence.scans->load(0).name == "000001");
  CHECK(sequence.scans->load(3).name == "000006");
  check_says(join(sequence.losses, "\n"), {"2 messages of 7 left out", "1 without a point",
                                           "1 that cannot be read, the first:", "message 5",
                                           "1 of 5 scans have no pose: 1 before the first pose"});
}

TEST_CASE("A bag that was cut opens with what is there, and says so", "[bags]") {
  const TemporaryFolder folder;
  MadeBag bag(folder / "drive.bag");
  bag.odometry(100, shift(0));
  bag.odometry(101, shift(10));
  add_clouds(bag);
  const std::string path = bag.finish();
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 300);
  const Sequence sequence = open_sequence(path, {});
  CHECK(sequence.scans->size() == 4);
  REQUIRE_FALSE(sequence.damage.empty());
  check_says(sequence.damage[0], {"drive.bag", "truncated"});
  CHECK(lost_scan_lines(sequence) == sequence.damage);
  // Damage is reported first.
  const std::vector<std::string> lines = opening_lines(sequence);
  CHECK(lines.size() == sequence.damage.size() + sequence.notes.size());
  CHECK(lines.at(0) == sequence.damage[0]);
  CHECK(lines.back() == sequence.notes.back());
}

}  // namespace
}  // namespace raymoval::test
