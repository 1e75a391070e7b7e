// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/bags/messages/pose_messages.h"
#include "tests/datasets/bags/message_bytes.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {
namespace {

constexpr auto kRos1 = MessageEncoding::kRos1;
constexpr auto kCdr = MessageEncoding::kCdr;
const std::string kCloud = "sensor_msgs/PointCloud2";
const std::string kLivox = "livox_ros_driver2/CustomMsg";

/// The three ways in which a message may be written.
std::vector<std::pair<MessageEncoding, MessageBytes>> writings() {
  return {{kRos1, MessageBytes(kRos1)},
          {kCdr, MessageBytes(kCdr)},
          {kCdr, MessageBytes(kCdr, /*big_endian=*/true)}};
}

PointRecords points_of(const std::string& message, MessageEncoding encoding = kRos1,
                       const std::string& type = kCloud) {
  return read_points(message, type, encoding, "x.bag: /points, message 3");
}

std::string refusal(const std::string& message, MessageEncoding encoding = kRos1,
                    const std::string& type = kCloud) {
  return message_of<DataError>([&] { (void)points_of(message, encoding, type); });
}

/// Two rows of two points x y z ring, with 2 bytes that mean nothing behind each point and 3 behind
/// each row.
CloudHead padded_head() {
  CloudHead head;
  head.height = head.width = 2;
  head.fields.push_back({"ring", 12, 4, 0});  // Drivers write a count of 0, too.
  head.point_step = 16;
  head.row_step = 35;
  return head;
}
std::string padded_point(float x, std::uint16_t ring) {
  return floats({x, 0, 1}) + bytes_of(std::vector<std::uint16_t>{ring, 0xABCD});
}
std::string padded_data() {
  return padded_point(1, 10) + padded_point(2, 20) + "###" + padded_point(3, 30) +
         padded_point(4, 40) + "###";
}

TEST_CASE("A PointCloud2 gives all fields of all points in every serialisation", "[bags]") {
  for (const auto& [encoding, writing] : writings()) {
    const PointRecords points =
        points_of(cloud_message(writing, padded_head(), padded_data()), encoding);
    REQUIRE(points.size() == 4);
    CHECK(points.width == 2);
    CHECK(points.height == 2);
    CHECK(points.layout.row_bytes == 16);
    const PointField* ring = points.layout.find({"ring"});
    REQUIRE(ring != nullptr);
    CHECK(ring->text() == "uint16 ring");
    CHECK(ring->offset == 12);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(points.value(i, points.layout.fields[0]) == static_cast<double>(i + 1));
      CHECK(points.value(i, *ring) == 10.0 * static_cast<double>(i + 1));
      CHECK(std::to_integer<int>(points.row(i)[14]) == 0xCD);  // What means nothing stays, too.
    }
  }
}

TEST_CASE("Big-endian points are turned to little-endian, overlapping fields once", "[bags]") {
  CloudHead head;
  head.width = 1;
  head.big_endian = true;
  head.fields = {{"x", 0, 7},    {"y", 4, 7},     {"z", 8, 7},
                 {"rgb", 12, 7}, {"rgba", 12, 6}, {"t", 16, 8}};
  head.point_step = 24;
  MessageBytes data(kCdr, true);  // Its bytes behind the head are big-endian.
  data.f32(1).f32(2).f32(3).u32(0x00112233).f64(0.5);
  const PointRecords points =
      points_of(cloud_message(MessageBytes(kRos1), head, data.bytes().substr(4)));
  CHECK(points.value(0, *points.layout.find({"z"})) == 3);
  CHECK(points.value(0, *points.layout.find({"rgba"})) == 0x00112233);
  CHECK(points.value(0, *points.layout.find({"t"})) == 0.5);
}

/// What `read_points` gives, as positions and strengths.
Cloud through_records(const std::string& message, MessageEncoding encoding,
                      const Eigen::Vector3d& origin) {
  const PointRecords records = points_of(message, encoding);
  Cloud cloud;
  const PointField* intensity = records.layout.find({"intensity"});
  for (std::size_t i = 0; i < records.size(); ++i) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = records.value(i, records.layout.fields[axis]);
    cloud.points.push_back((point - origin).cast<float>());
    if (intensity == nullptr) continue;
    cloud.intensity.push_back(static_cast<float>(records.value(i, *intensity)));
  }
  return cloud;
}

TEST_CASE("Positions are those of the records, with padding, gaps and either byte order",
          "[bags]") {
  CloudHead doubles;
  doubles.width = 2;
  doubles.fields = {{"x", 4, 8}, {"y", 12, 8}, {"z", 20, 8}, {"intensity", 0, 6}};
  doubles.point_step = 28;
  const std::string point = MessageBytes(kRos1).u32(7).f64(1e6).f64(2).f64(3).bytes();
  CloudHead swapped = padded_head();
  swapped.big_endian = true;
  for (const auto& [encoding, writing] : writings()) {
    for (const Eigen::Vector3d& origin :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(999'999, 1, 0)}) {
      for (const std::string& message : {cloud_message(writing, padded_head(), padded_data()),
                                         cloud_message(writing, swapped, padded_data()),
                                         cloud_message(writing, doubles, point + point)}) {
        const Cloud cloud = read_point_positions(message, kCloud, encoding, origin, "m");
        const Cloud expected = through_records(message, encoding, origin);
        CHECK(cloud.points == expected.points);
        CHECK(cloud.intensity == expected.intensity);
      }
    }
  }
  CloudHead flat = padded_head();
  flat.fields[2].name = "height";
  const std::string message = cloud_message(MessageBytes(kRos1), flat, padded_data());
  check_says(message_of<DataError>([&] {
               (void)read_point_positions(message, kCloud, kRos1, Eigen::Vector3d::Zero(), "m");
             }),
             {"m", "'z'"});
}

TEST_CASE("A row_step that drivers leave wrong is read as what stands there", "[bags]") {
  CloudHead head;
  head.width = 2;
  const std::string data = floats({1, 2, 3, 4, 5, 6});
  for (const std::uint32_t row_step : {0U, 12U, 99U}) {
    head.row_step = row_step;
    const PointRecords points = points_of(cloud_message(MessageBytes(kRos1), head, data));
    CHECK(points.value(1, points.layout.fields[2]) == 6);
  }
  head.width = 0;
  CHECK(points_of(cloud_message(MessageBytes(kRos1), head, "")).size() == 0);
}

TEST_CASE("A cloud that contradicts itself is refused with the reason", "[bags]") {
  const auto refused = [](const std::function<void(CloudHead&)>& change) {
    CloudHead head = padded_head();
    change(head);
    return refusal(cloud_message(MessageBytes(kRos1), head, padded_data()));
  };
  check_says(refused([](CloudHead& head) { head.fields[3].type = 9; }),
             {"x.bag: /points, message 3", "'ring'", "unknown type 9", "expected 1 (int8)"});
  check_says(refused([](CloudHead& head) { head.point_step = 13; }),
             {"'ring' ends at byte 14", "point_step is 13"});
  check_says(refused([](CloudHead& head) { head.height = 3; }),
             {"3 x 2 points of 16 bytes take 102 bytes, but data has 70"});
  check_says(refused([](CloudHead& head) { head.fields[0].count = 0xFFFFFFFF; }),
             {"4,294,967,295"});
  check_says(
      refused([](CloudHead& head) { head.width = head.height = head.row_step = 0xFFFFFFFF; }),
      {"message 3", "a scan has at most 16,777,216"});
  check_says(refused([](CloudHead& head) {
               head.point_step = 0;
               head.fields.clear();
             }),
             {"point_step is 0"});
}

TEST_CASE("A small message cannot announce many points", "[bags]") {
  // All of them would be the same bytes.
  CloudHead head;
  head.width = 70;
  head.point_step = 1;
  head.fields = {{"x", 0, 2}, {"y", 0, 2}, {"z", 0, 2}};
  const auto said = [&] {
    return refusal(cloud_message(MessageBytes(kRos1), head, padded_data()));
  };
  check_says(said(), {"message 3", "'x' and 'y' share bytes", "Correct the offsets"});
  head.point_step = 6;
  head.fields = {{"x", 2, 3}, {"y", 0, 3}, {"z", 3, 3}};
  check_says(said(), {"'x' and 'z' share bytes"});
  head.fields = {{"x", 4, 3}, {"y", 2, 3}, {"z", 0, 3}, {"all", 0, 2, 6}, {"rgb", 0, 2, 6}};
  head.width = 11;
  CHECK(points_of(cloud_message(MessageBytes(kRos1), head, padded_data())).size() == 11);
  head.fields.insert(head.fields.end(), 10, {"more", 0, 2, 6});
  check_says(said(), {"take 78 bytes of a point", "point_step is 6"});
}

TEST_CASE("A message that is cut anywhere says so with its field", "[bags]") {
  for (const auto& [encoding, writing] : writings()) {
    const std::string cloud = cloud_message(writing, padded_head(), padded_data());
    for (std::size_t size = 0; size < cloud.size(); ++size) {
      check_says(refusal(cloud.substr(0, size), encoding), {"message 3", "its "});
    }
    MessageBytes odometry = writing;
    odometry.header(1, 2, "odom").text("base").motion({1, 2, 3, 0, 0, 0, 1});
    for (std::size_t size = 0; size < odometry.bytes().size(); ++size) {
      const std::string cut = odometry.bytes().substr(0, size);
      CHECK_THROWS_AS(read_poses(cut, "nav_msgs/Odometry", encoding, "m"), DataError);
    }
  }
}

TEST_CASE("Other kinds of CDR are refused", "[bags]") {
  check_says(refusal(std::string("\0\7\0\0....", 8), kCdr), {"kind 0.7", "plain CDR"});
  check_says(refusal("....", MessageEncoding::kOther), {"neither as ROS 1 nor as CDR"});
}

std::string livox_message(MessageBytes message, const std::vector<float>& xs) {
  message.header(1000, 5, "livox").number(std::uint64_t{1000000000005});
  message.u32(static_cast<std::uint32_t>(xs.size())).u8(1).u8(0).u8(0).u8(0);
  message.u32(static_cast<std::uint32_t>(xs.size()));
  for (const float x : xs) {
    message.u32(static_cast<std::uint32_t>(1000 * x)).f32(x).f32(-x).f32(0.5F);
    message.u8(200).u8(16).u8(3);
  }
  return message.bytes();
}

TEST_CASE("Livox's CustomMsg gives its points with all fields", "[bags]") {
  for (const auto& [encoding, writing] : writings()) {
    const std::string message = livox_message(writing, {1, 2, 3});
    const PointRecords points = points_of(message, encoding, kLivox);
    REQUIRE(points.size() == 3);
    CHECK(points.layout.row_bytes == 19);
    const auto value = [&](const char* name) {
      return points.value(2, *points.layout.find({name}));
    };
    CHECK(value("offset_time") == 3000);
    CHECK(value("x") == 3);
    CHECK(value("y") == -3);
    CHECK(value("reflectivity") == 200);
    CHECK(value("tag") == 16);
    CHECK(value("line") == 3);
    const PointsHead head = read_points_head(message, kLivox, encoding, "m");
    CHECK(head.size == 3);
    CHECK(head.header.stamp == 1000000000005);
    CHECK(head.header.frame_id == "livox");
  }
}

TEST_CASE("Poses are read from each message that has them", "[bags]") {
  const std::vector<double> motion = {1, 2, 3, 0, 0, 1, 0};
  for (const auto& [encoding, writing] : writings()) {
    const auto read = [&, encoding = encoding](const MessageBytes& message, const char* type) {
      return read_poses(message.bytes(), type, encoding, "m");
    };
    MessageBytes odometry = writing, pose = writing, tf = writing, path = writing;
    odometry.header(7, 8, "/odom").text("base").motion(motion);
    pose.header(7, 8, "map").motion(motion);
    tf.u32(2);
    tf.header(7, 8, "map")
        .text("odom")
        .motion(motion)
        .header(9, 0, "odom")
        .text("/base")
        .motion(motion);
    path.header(0, 0, "map")
        .u32(2)
        .header(7, 8, "map")
        .motion(motion)
        .header(9, 0, "map")
        .motion(motion);

    const PoseMessage found = read(odometry, "nav_msgs/Odometry").at(0);
    CHECK(found.stamp == 7'000'000'008);
    CHECK(found.frame == "odom");
    CHECK(found.child == "base");
    CHECK(found.position == Eigen::Vector3d(1, 2, 3));
    // Half a turn about z.
    CHECK((rigid_pose(found, "m").linear() * Eigen::Vector3d::UnitX())
              .isApprox(-Eigen::Vector3d::UnitX()));
    CHECK(read(pose, "geometry_msgs/PoseStamped").at(0).child.empty());
    CHECK(read(pose, "geometry_msgs/PoseWithCovarianceStamped").at(0).position.z() == 3);
    CHECK(read(odometry, "geometry_msgs/TransformStamped").at(0).child == "base");
    const auto transforms = read(tf, "tf2_msgs/TFMessage");
    REQUIRE(transforms.size() == 2);
    CHECK(transforms[1].child == "base");
    CHECK(transforms[1].stamp == 9'000'000'000);
    CHECK(read(path, "nav_msgs/Path").size() == 2);
  }
}

TEST_CASE("A pose that is no rigid motion is refused", "[bags]") {
  PoseMessage pose;
  pose.frame = "odom";
  pose.attitude.coeffs().setZero();
  check_says(message_of<DataError>([&] { (void)rigid_pose(pose, "m"); }), {"odom", "length 0"});
  pose.attitude.setIdentity();
  pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(rigid_pose(pose, "m"), DataError);
}

}  // namespace
}  // namespace raymoval::test
