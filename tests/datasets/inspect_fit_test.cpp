// SPDX-License-Identifier: MIT
// Poses that are nearly right, and points that are not in the frame of their sensor.
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/flat_world.h"
#include "tests/datasets/inspect_data.h"
#include "tests/datasets/written_cloud.h"
#include "tests/datasets/wrong_poses.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// The exact street of 50 scans, 1 m apart.
InspectionReport inspect_street(const std::function<Eigen::Vector3d(std::size_t)>& error,
                                const SequenceOptions& options = {}) {
  Sequence street = make_street({}, street_boxes(), options);
  street.scans = std::make_shared<toy::ChangedScans>(wrong_poses(error, options));
  return inspect(street, 2);
}

Eigen::Vector3d right(std::size_t /*scan*/) {
  return Eigen::Vector3d::Zero();
}

}  // namespace

TEST_CASE("how well right poses fit is reported, and no finding", "[inspect]") {
  const InspectionReport report = inspect_street(right);
  check_silent(report);
  CHECK_THAT(report.pose_fit, Catch::Contains("poses fit to 0.000 m (median of "));
}

TEST_CASE("a doubt about estimated poses is a finding", "[inspect]") {
  Sequence street = make_street({}, street_boxes());
  street.pose_doubts = {"scans 0 to 9 also fit a motion of 0.00 m"};
  const InspectionReport report = inspect(street, 2);
  check_finds(report, "motion-uncertain", "--poses FILE");
  CHECK(report.findings[0].consequence == Consequence::kRefused);
}

TEST_CASE("a jump of the poses is found between two frames, and each side fits",
          "[inspect][slow]") {
  const auto jump = [](std::size_t scan) -> Eigen::Vector3d {
    return {0.0, scan < 30 ? 0.0 : 0.5, 0.0};
  };
  // The longer side is that before the jump.
  check_finds(inspect_street(jump), "poses-do-not-fit", "--frames 0:29)");
  SequenceOptions before;
  before.frames = parse_frame_range("0:29");
  check_silent(inspect_street(jump, before));
}

TEST_CASE("noise of the poses, a climb and a drift to the side do not fit", "[inspect][slow]") {
  const auto noise = [](std::size_t scan) -> Eigen::Vector3d {
    const auto level = [&](std::size_t step) {
      return 0.15 * (static_cast<double>(scan * step % 5) - 2.0) / 1.4;  // RMS 0.15 m
    };
    return {0.0, level(3), level(2)};
  };
  check_finds(inspect_street(noise), "poses-do-not-fit", "SLAM");
  const auto climb = [](std::size_t scan) -> Eigen::Vector3d {
    return {0.0, 0.0, 0.02 * static_cast<double>(scan)};
  };
  check_finds(inspect_street(climb), "poses-do-not-fit");
}

TEST_CASE("points in the frame of a vehicle are named, and brought to their sensor on request",
          "[inspect][slow]") {
  // The sensor is 0.8 m ahead of the vehicle's origin, 0.3 m to its left and 1.7 m above it.
  const Eigen::Vector3d sensor(0.8, 0.3, 1.7);
  const Sequence street = make_street({}, street_boxes());
  const TemporaryFolder folder;
  std::string poses;
  for (std::size_t i = 0; i < street.scans->size(); ++i) {
    Scan scan = street.scans->load(i);
    for (Eigen::Vector3f& point : scan.points) point += sensor.cast<float>();
    write_cloud(folder / (scan.name + ".bin"), scan.points, std::vector<float>(scan.size()));
    const Eigen::Vector3d t = scan.T_world_sensor.translation() - sensor;
    poses += "1 0 0 " + number_text(t.x()) + " 0 1 0 " + number_text(t.y()) + " 0 0 1 " +
             number_text(t.z()) + "\n";
  }
  folder.write("poses.txt", poses);
  const InspectionReport report = inspect_path(folder.text(), {});
  check_finds(report, "beams-start-elsewhere", "--sensor-origin 0.");
  const std::string& remedy = report.findings[0].remedy;
  const std::string text = remedy.substr(remedy.rfind(' ') + 1);
  const Eigen::Vector3d advised = parse_sensor_places(text.substr(0, text.size() - 1)).one;
  CHECK((advised - sensor).norm() < 0.15);

  SequenceOptions options;
  options.sensor_origin = sensor;
  check_silent(inspect_path(folder.text(), options));
  const Sequence brought = open_sequence(folder.text(), options);
  CHECK(brought.record().sensor_origin == "0.8,0.3,1.7");
  // The advice on a wrong origin is about the stored points.
  options.sensor_origin = Eigen::Vector3d(sensor + Eigen::Vector3d::UnitY());
  check_finds(inspect_path(folder.text(), options), "beams-start-elsewhere", "--sensor-origin 0.");
  for (const std::size_t i : {std::size_t{0}, std::size_t{31}}) {
    const Scan seen = brought.scans->load(i), truth = street.scans->load(i);
    CHECK(seen.T_world_sensor.isApprox(truth.T_world_sensor, 1e-6));
    CHECK(brought.scans->pose(i).isApprox(seen.T_world_sensor, 0.0));
    REQUIRE(seen.size() == truth.size());
    double most = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      most = std::max<double>(most, (seen.points[k] - truth.points[k]).norm());
    }
    CHECK(most < 1e-5);
  }
}

TEST_CASE("missing returns that were moved with their sensor are left out", "[inspect]") {
  // A driver writes (0, 0, 0) where nothing came back, and a program moves it to the vehicle.
  const TemporaryFolder folder;
  write_cloud(folder / "000000.bin", {{1.2F, 0.0F, 1.8F}, {6.2F, 0.0F, 1.8F}}, {0.0F, 0.5F});
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  SequenceOptions options;
  options.sensor_origin = Eigen::Vector3d(1.2, 0.0, 1.8);
  const Scan scan = open_sequence(folder.text(), options).scans->load(0);
  REQUIRE(scan.size() == 1);
  CHECK(scan.points[0].isApprox(Eigen::Vector3f(5.0F, 0.0F, 0.0F), 1e-6F));
  CHECK(scan.stored_position(0) == 1);
  CHECK(scan.T_world_sensor.translation().isApprox(options.sensor_origin->one));

  CHECK_THROWS_AS(parse_sensor_places("1.2,0"), UsageError);
  CHECK_THROWS_AS(parse_sensor_places("1.2,0,up"), UsageError);
  CHECK_THROWS_AS(parse_sensor_places("1200,0,0"), UsageError);
}

namespace {

InspectionReport inspect_world(FlatWorld world) {
  Sequence sequence;
  sequence.name = "flat";
  sequence.layout = "simulated";
  sequence.scans = std::make_shared<FlatWorld>(std::move(world));
  sequence.up_choice = std::make_shared<UpChoice>(std::nullopt);
  return inspect(sequence);
}

}  // namespace

TEST_CASE("floor and ceiling of a room are no part of the machine that carries the sensor",
          "[inspect][slow]") {
  // A room of 7 x 6 m and 2.5 m in height, and a sensor in the hand, 1.2 m above the floor.
  FlatWorld world;
  for (int i = 0; i < 16; ++i) {
    const double angle = 45.0 * kDegree * i;
    Pose pose(Eigen::Translation3d(1.8 * std::cos(angle), 1.4 * std::sin(angle), 1.2));
    // No wall stays ahead.
    pose.linear() = Eigen::AngleAxisd(2.9 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    world.scan(inside_of_box(7.0, 6.0, 2.5), pose);
  }
  check_silent(inspect_world(world));
}

TEST_CASE("a straight tunnel says nothing about skew", "[inspect][slow]") {
  std::vector<Rectangle> tunnel;
  for (const double z : {0.0, 6.0}) tunnel.push_back({{0, 0, z}, {300, 0, 0}, {0, 4, 0}});
  for (const double y : {-4.0, 4.0}) tunnel.push_back({{0, y, 3}, {300, 0, 0}, {0, 0, 3}});
  FlatWorld world;
  for (int i = 0; i < 30; ++i) world.scan(tunnel, Pose(Eigen::Translation3d(1.5 * i, 0, 1.8)));
  // Without noise all scans are alike.
  CHECK(found(inspect_world(world)) == std::set<std::string>{"duplicated-scans"});
}
