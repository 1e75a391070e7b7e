// SPDX-License-Identifier: MIT
#include "datasets/trajectories/trajectory.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

constexpr Nanoseconds kSecond = 1'000'000'000;

Pose at(double x, double yaw = 0.0) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x;
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// A body that moves 10 m/s along x from second 100 on, and turns by 0.2 rad per second.
/// @param T_body_sensor pose of the sensor on the body
SensorMotion motion_of_body(Nanoseconds time_offset = 0,
                            const Pose& T_body_sensor = Pose::Identity()) {
  const Trajectory trajectory(
      {{100 * kSecond, at(0)}, {101 * kSecond, at(10, 0.2)}, {104 * kSecond, at(40, 0.8)}});
  return SensorMotion({{trajectory}, {{}, T_body_sensor}}, time_offset);
}

}  // namespace

TEST_CASE("poses are interpolated between two that are near enough", "[trajectories]") {
  const SensorMotion motion = motion_of_body();
  const auto found = motion.at(100 * kSecond + kSecond / 4);
  REQUIRE(found);
  CHECK(found->translation().x() == Approx(2.5));
  CHECK(Eigen::AngleAxisd(found->linear()).angle() == Approx(0.05));
  CHECK(motion.at(104 * kSecond)->translation().x() == 40.0);
  CHECK_FALSE(motion.at(102 * kSecond));  // Three seconds between the poses.
  CHECK_FALSE(motion.at(100 * kSecond - 1));
  CHECK_FALSE(motion.at(104 * kSecond + 1));
}

TEST_CASE("a sensor on a body goes along, on a clock of its own", "[trajectories]") {
  // Two metres ahead of the body's origin.
  const SensorMotion motion = motion_of_body(100 * kSecond, at(2.0));
  CHECK(motion.span() == std::pair<Nanoseconds, Nanoseconds>(0, 4 * kSecond));
  const Pose pose = motion.at(kSecond).value();
  CHECK(pose.translation().x() == Approx(10.0 + 2.0 * std::cos(0.2)));
  CHECK(pose.translation().y() == Approx(2.0 * std::sin(0.2)));
}

TEST_CASE("scans without a pose are counted, never guessed", "[trajectories]") {
  const SensorMotion motion = motion_of_body();
  const std::vector<Nanoseconds> stamps = {99 * kSecond, 100 * kSecond, 101 * kSecond,
                                           102 * kSecond, 104 * kSecond};
  const FoundPoses found = look_up_poses(stamps, motion, "traj.txt");
  CHECK(found.missing == 2);
  CHECK_FALSE(found.poses[0]);
  CHECK(found.poses[1]);
  CHECK_FALSE(found.poses[3]);
  REQUIRE(found.losses.size() == 1);
  check_says(found.losses[0], {"traj.txt: 2 of 5 scans have no pose", "1 before the first pose",
                               "1 between poses that are too far apart", "left out"});
  CHECK(look_up_poses({100 * kSecond}, motion, "traj.txt").losses.empty());
}

TEST_CASE("half of the scans without a pose is an error that says what would help",
          "[trajectories]") {
  const SensorMotion motion = motion_of_body();
  const auto error = [&](const std::vector<Nanoseconds>& stamps) {
    return message_of<DataError>([&] { look_up_poses(stamps, motion, "traj.txt"); });
  };
  check_says(error({0, kSecond}),
             {"traj.txt: 2 of 2 scans have no pose", "The scans are from 0.000000000 s to 1.000",
              "the poses from 100.000000000 s to 104.0", "--time-offset 100.000000000"});
  check_says(error({102 * kSecond, 103 * kSecond}), {"too far apart in time", "--max-gap"});
  check_says(error({99 * kSecond, 100 * kSecond}), {"--frames", "--time-offset 1.000000000"});
  // The named shift helps.
  CHECK(look_up_poses({0, kSecond}, motion_of_body(100 * kSecond), "traj.txt").missing == 0);
}
