// SPDX-License-Identifier: MIT
// Defects made in a good drive that was traced in memory. Defects of files are in
// inspect_files_test.cpp.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/scan/local_frame.h"
#include "core/scan/reach.h"
#include "datasets/simulation/scene/library.h"
#include "tests/datasets/inspect_data.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// LiDAR (x ahead, y left, z up) to camera (x right, y down, z ahead).
Pose to_camera() {
  Pose C = Pose::Identity();
  C.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return C;
}

void turn_world(EditedSequence& drive, double yaw) {
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  drive.each_pose([&](const Pose& pose) { return turn * pose; });
}

}  // namespace

TEST_CASE("a good drive is silent", "[inspect]") {
  check_silent(good_drive().inspected());
  EditedSequence turned = good_drive();
  turn_world(turned, 2.0);
  check_silent(turned.inspected());
}

TEST_CASE("a recording that is cut is a finding, and scans without a pose are a note",
          "[inspect]") {
  EditedSequence drive = good_drive();
  drive.losses = {"poses.txt: 3 of 19 scans have no pose: 3 after the last pose."};
  CHECK_FALSE(drive.inspected().has_findings());
  CHECK(drive.inspected().notes == drive.losses);
  drive.damage = {"drive.bag: byte 77: a chunk is truncated; 2 messages of it can be read.",
                  "Further damage was found in 9 places, not listed here."};
  const InspectionReport report = drive.inspected();
  CHECK(report.notes == drive.losses);
  CHECK(found(report) == std::set<std::string>{"recording-damaged"});
  REQUIRE(report.findings.size() >= 2);
  CHECK(report.findings[0].consequence == Consequence::kWarned);
  CHECK(report.findings[0].sentence().starts_with(
      "recording-damaged: drive.bag: byte 77: a chunk is truncated; 2 messages of it can be read; "
      "expected a whole recording"));
  CHECK(report.findings[1].where == "the recording");
}

TEST_CASE("the scenes are silent", "[inspect][slow]") {
  for (const char* scene : {"town", "country", "crossing", "highway", "excavator"}) {
    SimulationOptions options;
    options.scene = scene;
    options.scans = 12;
    if (options.scene != "excavator") options.sensor = sparse_vlp16();
    INFO(scene);
    const InspectionReport report = EditedSequence(options).inspected();
    INFO(text_of(report));
    CHECK(found(report).empty());
    // Their world is upright, hills and all.
    for (const Finding& finding : report.findings) CHECK(finding.check != "world-axes");
  }
}

TEST_CASE("key frames of a motorway at 2 Hz, 15 m apart, have no finding", "[inspect][slow]") {
  for (const char* sensor : {"vlp16", "hdl64e"}) {
    SimulationOptions options;
    options.scene = "motorway";
    options.scans = 80;
    options.sensor = sensor_with_step(sensor, "0.8");
    const InspectionReport report = EditedSequence(options, 5).inspected();
    INFO(sensor << "\n" << text_of(report));
    CHECK(found(report).empty());
  }
}

TEST_CASE("a narrow view tells poses that the ground alone contradicts", "[inspect][slow]") {
  // The sensor is pitched down by 35 degrees. As poses of a car that drives ahead, its poses would
  // lead into the ground.
  SimulationOptions options;
  options.scene = "walk";
  options.scans = 12;
  options.sensor = "rosette";
  EditedSequence drive(options);
  for (Scan& scan : drive.scans) {
    scan.T_world_sensor = Pose::Identity();
    scan.T_world_sensor.translation().x() = static_cast<double>(scan.index);
  }
  CHECK(found(drive.inspected()).count("poses-of-another-sequence") == 1);
}

TEST_CASE("positions that lost their digits far from the origin are named", "[inspect][slow]") {
  EditedSequence coarse = good_drive();
  coarse.each_pose([](const Pose& pose) {
    Pose far = Eigen::Translation3d(691000.25, 5336000.5, 512.0) * pose;
    // As a C++ stream writes them by default, with six digits.
    far.translation().x() = std::round(far.translation().x());
    far.translation().y() = std::round(far.translation().y() / 10.0) * 10.0;
    return far;
  });
  check_finds(coarse.inspected(), "poses-coarse", "digits");
}

TEST_CASE("a world whose z is not up is a note", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  const Pose turn(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  drive.each_pose([&](const Pose& pose) { return turn * pose; });
  const InspectionReport report = drive.inspected();
  INFO(text_of(report));
  CHECK(found(report).empty());
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings.front().check == "world-axes");
  CHECK_THAT(report.findings.front().what, Catch::Contains("up is -y"));
}

TEST_CASE("up that the scans contradict is named", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  drive.up = Eigen::Vector3d::UnitZ();
  check_silent(drive.inspected());
  drive.up = Eigen::Vector3d(0, -1, 0);
  check_finds(drive.inspected(), "up-contradicted", "--up");
}

TEST_CASE("inverted poses are named", "[inspect]") {
  EditedSequence drive = good_drive();
  drive.each_pose([](const Pose& pose) { return pose.inverse(); });
  check_finds(drive.inspected(), "poses-inverted", "R^T");
}

TEST_CASE("camera frames are told from the LiDAR's", "[inspect][slow]") {
  const Pose C = to_camera();
  EditedSequence poses = good_drive();
  poses.each_pose([&](const Pose& pose) { return C * pose * C.inverse(); });
  check_finds(poses.inspected(), "camera-frame", "Tr^-1 P Tr");
  EditedSequence lidar_as_camera = good_drive();
  lidar_as_camera.each_pose([&](const Pose& pose) { return C.inverse() * pose * C; });
  check_finds(lidar_as_camera.inspected(), "lidar-poses-as-camera", "poses_are_lidar");
}

TEST_CASE("points in camera axes are told by the ground", "[inspect][slow]") {
  const Pose C = to_camera();
  // Enough beams to see the ground as a plane.
  EditedSequence points(suburb(sparse_hdl64e(), 10));
  points.each_point([&](const Scan&, const Eigen::Vector3d& p) { return C * p; });
  EditedSequence both = points;
  both.each_pose([&](const Pose& pose) { return C * pose * C.inverse(); });
  check_finds(points.inspected(), "camera-frame", "Points in a camera frame");
  // They fit each other, and the axis about which the sensor spins is found.
  CHECK(found(both.inspected()).empty());
}

TEST_CASE("millimetres are named, in points and in poses", "[inspect][slow]") {
  EditedSequence poses = good_drive();
  poses.each_pose([](Pose pose) {
    pose.translation() *= 1000.0;
    return pose;
  });
  check_finds(poses.inspected(), "poses-in-millimetres", "1,000");
  EditedSequence points = good_drive();
  points.each_point([](const Scan&, const Eigen::Vector3d& p) { return 1000.0 * p; });
  check_finds(points.inspected(), "points-in-millimetres", "0.001");
  points.each_pose([](Pose pose) {
    pose.translation() *= 1000.0;
    return pose;
  });
  CHECK(found(points.inspected()) ==
        std::set<std::string>{"points-in-millimetres", "poses-in-millimetres"});
}

TEST_CASE("both units are named if the points may be either", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  drive.each_point([](const Scan&, const Eigen::Vector3d& p) { return 100.0 * p; });
  drive.each_pose([](Pose pose) {
    pose.translation() *= 100.0;
    return pose;
  });
  const InspectionReport report = drive.inspected();
  INFO(text_of(report));
  REQUIRE(found(report).contains("points-in-millimetres"));
  const auto finding =
      std::find_if(report.findings.begin(), report.findings.end(),
                   [](const Finding& one) { return one.check == "points-in-millimetres"; });
  CHECK_THAT(finding->what, Catch::Contains("millimetres") && Catch::Contains("centimetres"));
  CHECK_THAT(finding->remedy, Catch::Contains("by 0.001 if") && Catch::Contains("by 0.01 if"));
}

TEST_CASE("a quaternion's order is named", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  turn_world(drive, 0.7);
  // Written as w x y z, read as x y z w.
  drive.each_pose([](Pose pose) {
    const Eigen::Quaterniond q(pose.linear());
    pose.linear() = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
    return pose;
  });
  check_finds(drive.inspected(), "quaternion-order", "columns");
}

TEST_CASE("poses of another sequence are named", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  // The poses of a drive that turns the other way and twice as fast.
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const auto s = static_cast<double>(i);
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(-0.08 * s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(2.1 * s, -0.06 * s * s, 0.0);
    drive.scans[i].T_world_sensor = pose;
  }
  check_finds(drive.inspected(), "poses-of-another-sequence", "belongs to these scans");
}

TEST_CASE("a scan with far fewer points than its neighbours is named", "[inspect]") {
  EditedSequence drive = good_drive();
  Scan& cut = drive.scans[5];
  cut.points.resize(cut.size() * 7 / 10);
  cut.reflectance.resize(cut.size());
  cut.stored_point_count = cut.size();
  drive.words[5].resize(cut.size());
  const InspectionReport report = drive.inspected();
  check_finds(report, "few-points", "Copy the scan again");
  CHECK(report.findings[0].where == "scan 5");
}

TEST_CASE("duplicated scans are named", "[inspect]") {
  EditedSequence drive = good_drive();
  drive.scans[9].points = drive.scans[8].points;
  drive.scans[9].T_world_sensor = drive.scans[8].T_world_sensor;
  drive.scans[9].stored_point_count = drive.scans[8].stored_point_count;
  drive.words[9] = drive.words[8];
  const InspectionReport report = drive.inspected();
  INFO(text_of(report));
  // A pose that is repeated for one scan and corrected in the next is a jump as well.
  CHECK(found(report).count("duplicated-scans") == 1);
}

TEST_CASE("scans left out show in the motion", "[inspect][slow]") {
  EditedSequence drive(suburb(sparse_vlp16(), 19));
  drive.scans.erase(drive.scans.begin() + 6, drive.scans.begin() + 9);
  drive.words.erase(drive.words.begin() + 6, drive.words.begin() + 9);
  for (std::size_t i = 0; i < drive.size(); ++i) drive.scans[i].index = i;
  check_finds(drive.inspected(), "jump-in-motion", "missing scans");
}

TEST_CASE("labels of the next or the last scan are named", "[inspect][slow]") {
  for (const bool next : {true, false}) {
    EditedSequence drive = good_drive();
    const auto good = drive.words;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      const std::size_t other =
          next ? std::min(i + 1, drive.size() - 1) : (i == 0 ? std::size_t{0} : i - 1);
      drive.words[i] = good[other];
    }
    const InspectionReport by_count = drive.inspected();
    check_finds(by_count, "labels-shifted", "Rename");
    CHECK_THAT(by_count.findings[0].what, Catch::Contains(next ? "after it" : "before it"));
    // With equal counts, only the places of the labels show it.
    for (std::size_t i = 0; i < drive.size(); ++i) {
      drive.words[i].resize(drive.scans[i].size(), 40);
    }
    const InspectionReport by_place = drive.inspected();
    check_finds(by_place, "labels-shifted", "Rename");
    CHECK_THAT(by_place.findings[0].what, Catch::Contains(next ? "after it" : "before it"));
  }
}

TEST_CASE("skewed scans are named, corrected ones are not", "[inspect][slow]") {
  SimulationOptions options = suburb(sparse_hdl64e(), 14);
  options.scene = "country";  // At 10 m/s some pairs of scans are 6 m apart.
  options.rolling = Rolling::kSkewed;
  const InspectionReport report = EditedSequence(options).inspected();
  check_finds(report, "skewed-scans", "deskewing");
  CHECK_THAT(report.findings[0].what, Catch::Contains("clockwise from behind"));
  options.rolling = Rolling::kCorrected;
  check_silent(EditedSequence(options).inspected());
}

TEST_CASE("a sensor that is named by mistake is named", "[inspect][slow]") {
  EditedSequence drive(suburb("vlp16", 12));
  for (const char* name : {"hdl64e", "hdl32e", "os1-128"}) {
    INFO(name);
    drive.model = sensor_model_named(name);
    check_finds(drive.inspected(), "other-sensor", "--sensor estimated");
  }
  drive.model = sensor_model_named("vlp16");
  const InspectionReport report = drive.inspected();
  check_silent(report);
  CHECK_THAT(report.sensor, Catch::Contains("vlp16; the scans show 16 beams, 0.200 deg by 2.0"));
}

TEST_CASE("what the sensor is taken for is told, also where it is estimated", "[inspect]") {
  EditedSequence drive = good_drive();
  drive.model = estimate_sensor_model({drive.scans[0], drive.scans[8], drive.scans[15]});
  const InspectionReport report = drive.inspected();
  check_silent(report);
  CHECK_THAT(report.sensor,
             Catch::StartsWith("estimated: 16 beams, ") && Catch::Contains("from 3 scans with "));
}

TEST_CASE("points in a turned frame are of the same sensor, about another axis",
          "[inspect][slow]") {
  EditedSequence drive(suburb("vlp16", 12));
  Eigen::Matrix3d z_to_y;
  z_to_y << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  for (Scan& scan : drive.scans) turn_sensor_frame(z_to_y, scan);
  drive.model = sensor_model_named("vlp16");
  const InspectionReport report = drive.inspected();
  check_silent(report);
  CHECK_THAT(report.sensor,
             Catch::StartsWith("vlp16; the scans show 16 beams, ") && Catch::EndsWith("axis: y"));
}

TEST_CASE("a cut at a range is named", "[inspect]") {
  EditedSequence drive = good_drive();
  drive.keep([](const Eigen::Vector3f& point) { return point.norm() < 25.0F; });
  check_finds(drive.inspected(), "range-truncated", "unfiltered");
}

TEST_CASE("a vehicle that is hardly in view is no matter, whatever is evaluated",
          "[inspect][slow]") {
  // Ten points a scan, 0.03 %; see kManyEgoPoints and ego_test.cpp.
  EditedSequence drive(suburb(sparse_hdl64e(), 14));
  check_silent(drive.inspected());
  drive.range_m.min = 0.0;
  check_silent(drive.inspected());
  drive.labelled = false;
  check_silent(drive.inspected());
}

TEST_CASE("positions and points beyond the reach of voxels are found", "[inspect][slow]") {
  EditedSequence drive = good_drive();
  SECTION("a position") {
    for (const double far : {1.01 * kUsualReach, 1e9, 1e16, 1e300}) {
      drive = good_drive();
      drive.scans[7].T_world_sensor.translation().y() = far;
      const InspectionReport report = drive.inspected();
      INFO(far << "\n" << text_of(report));
      CHECK(found(report).contains("out-of-reach"));
    }
  }
  SECTION("a height") {
    drive.scans[7].T_world_sensor.translation().z() = -1.01 * kUsualReach;
    CHECK(found(drive.inspected()).contains("out-of-reach"));
  }
  SECTION("a world far from its origin") {
    const auto shifted = [](double metres) {
      EditedSequence moved = good_drive();
      moved.each_pose([&](Pose pose) { return pose.pretranslate(Eigen::Vector3d(metres, 0, 0)); });
      return found(moved.inspected());
    };
    CHECK(shifted(1e16).contains("out-of-reach"));
    CHECK(shifted(1e14).contains("out-of-reach"));
    CHECK_FALSE(shifted(6e6).contains("out-of-reach"));  // UTM and the like lose nothing.
  }
  SECTION("a point") {
    for (const float far : {1.01F * static_cast<float>(kFarthestReturn), 1e6F, 1e9F, 1e30F}) {
      drive = good_drive();
      drive.scans[0].points[1234].x() = -far;
      const InspectionReport report = drive.inspected();
      INFO(far << "\n" << text_of(report));
      CHECK(found(report).contains("out-of-reach"));
      CHECK_THAT(text_of(report), Catch::Matchers::Contains("point 1,234 lies"));
    }
  }
}
