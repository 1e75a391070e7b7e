// SPDX-License-Identifier: MIT
// Folders of scans whose poses go by time, by row, or are one for all.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/open_folders.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// Ten metres a second along x, from second 1000 to 1010, a pose a second.
std::string trajectory(double first = 1000.0) {
  std::string text;
  for (int i = 0; i <= 10; ++i) {
    text += std::to_string(first + i) + " " + std::to_string(10 * i) + " 0 0 0 0 0 1\n";
  }
  return text;
}

}  // namespace

TEST_CASE("stamped poses of another number than the scans go by time", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin", "1.bin", "2.bin"});
  folder.write("poses.txt", trajectory());
  folder.write("times.txt", "1000.5\n1001\n1003.25\n");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(xs_of(sequence) == std::vector<double>{5, 10, 32.5});
  CHECK(sequence.scans->load(2).time_s == 2.75);
  CHECK(sequence.stamps.at(2) == 1003250000000);
  CHECK(sequence.motion->at(1002000000000)->translation().x() == 20.0);
  CHECK(sequence.notes.empty());
  CHECK(sequence.losses.empty());
  CHECK(sequence.input_files ==
        std::vector<std::filesystem::path>{folder / "poses.txt", folder / "times.txt"});
  // Frames are chosen before poses are looked up.
  SequenceOptions last;
  last.frames = parse_frame_range("2:2");
  CHECK(xs_of(open_sequence(folder.text(), last)) == std::vector<double>{32.5});
}

TEST_CASE("scans are timed by their names", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"1600000000.500000000.bin", "1600000001.000000000.bin"});
  folder.write("poses.txt", trajectory(1600000000.0));
  CHECK(xs_of(open_sequence(folder.text(), {})) == std::vector<double>{5, 10});
}

TEST_CASE("a clock is shifted, and what lies outside is left out and said", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin", "1.bin", "2.bin"});
  folder.write("poses.txt", trajectory());
  folder.write("times.txt", "0\n1\n2\n");
  check_says(open_error(folder.text()),
             {"3 of 3 scans have no pose", "0.000000000 s to 2.000000000 s",
              "1000.000000000 s to 1010", "--time-offset 1000.000000000"});
  SequenceOptions options;
  options.time_offset_s = 1000.0;
  CHECK(xs_of(open_sequence(folder.text(), options)) == std::vector<double>{0, 10, 20});
  options.time_offset_s = 999.5;
  const Sequence some = open_sequence(folder.text(), options);
  CHECK(xs_of(some) == std::vector<double>{5, 15});
  CHECK(some.scans->load(0).name == "1");
  CHECK(some.stamps.size() == 2);
  CHECK(some.notes.empty());
  REQUIRE(some.losses.size() == 1);
  check_says(some.losses[0], {"1 of 3 scans have no pose: 1 before the first pose", "left out"});
  options.max_gap_s = 0.5;
  check_says(open_error(folder.text(), options), {"too far apart", "--max-gap"});
}

TEST_CASE("stamped poses without times of scans go by row", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"frame1.9.bin", "frame1.10.bin"});
  folder.write("poses.txt", "7 1 0 0 0 0 0 1\n7.5 2 0 0 0 0 0 1\n");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(xs_of(sequence) == std::vector<double>{1, 2});
  CHECK(sequence.scans->load(1).time_s == 0.5);
  folder.write("poses.txt", trajectory());
  check_says(open_error(folder.text()),
             {"holds 11 poses", "2 scans", "times.txt", "name their files"});
  SequenceOptions options;
  options.time_offset_s = 1.0;
  folder.write("poses.txt", kIdentityRow + kIdentityRow);
  check_says(open_error<UsageError>(folder.text(), options), {"--time-offset has no effect"});
}

TEST_CASE("a sensor that stands needs one pose, or none on request", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin", "1.bin", "2.bin"});
  check_says(open_error(folder.text()), {"no pose file 'poses.txt'", "KISS-ICP", "GLIM", "FAST-LIO",
                                         "docs/poses.md", "--poses identity"});
  SequenceOptions standing;
  standing.poses = "identity";
  const Sequence sequence = open_sequence(folder.text(), standing);
  CHECK(xs_of(sequence) == std::vector<double>{0, 0, 0});
  CHECK(sequence.poses_file == "identity");
  folder.write("poses.txt", "1 0 0 4 0 1 0 0 0 0 1 0\n");
  const Sequence one = open_sequence(folder.text(), {});
  CHECK(xs_of(one) == std::vector<double>{4, 4, 4});
  check_says(one.notes.at(0), {"one pose", "the sensor is stationary"});
}

TEST_CASE("poses of a body are taken to its sensor", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin"});
  // The body faces along y; its sensor is two metres ahead of it.
  folder.write("poses.txt", "0 -1 0 1 1 0 0 0 0 0 1 0\n");
  SequenceOptions options;
  options.T_sensor = "2,0,0,0,0,0,1";
  const auto position = [&] {
    const Sequence sequence = open_sequence(folder.text(), options);
    const Pose pose = sequence.scans->pose(0);
    return Eigen::Vector3d(pose.translation());
  };
  CHECK((position() - Eigen::Vector3d(1, 2, 0)).norm() < 1e-12);
  folder.write("T.txt", "# of the LiDAR\n1 0 0 2\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  options.T_sensor = "T.txt";
  CHECK((position() - Eigen::Vector3d(1, 2, 0)).norm() < 1e-12);
  const Sequence sequence = open_sequence(folder.text(), options);
  CHECK(sequence.input_files ==
        std::vector<std::filesystem::path>{folder / "T.txt", folder / "poses.txt"});
  folder.write("T.txt", "1 2 3\n");
  check_says(open_error(folder.text(), options), {"T.txt: has 3 numbers", "x,y,z,qx,qy,qz,qw"});
  options.T_sensor = "nothing";
  check_says(open_error<UsageError>(folder.text(), options),
             {"--T-sensor nothing", "is not a file"});
  options.T_sensor = "2,0,0,0,0,0,9";
  check_says(open_error(folder.text(), options), {"--T-sensor 2,0,0", "length 9"});
}

TEST_CASE("points in the world frame come back to the sensor", "[trajectories]") {
  const TemporaryFolder folder;
  folder.write("0.bin", floats({5, 7, 0, 1}));
  folder.write("poses.txt", "0 -1 0 5 1 0 0 2 0 0 1 0\n");
  folder.write("sequence.json", R"({"points": "world"})");
  // (5, 7, 0) lies five metres along the world's y from (5, 2, 0), which is ahead.
  const Scan scan = open_sequence(folder.text(), {}).scans->load(0);
  CHECK((scan.points.at(0) - Eigen::Vector3f(5, 0, 0)).norm() < 1e-5F);
}

TEST_CASE("SemanticKITTI takes stamped poses by time, and times.txt has one meaning",
          "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"velodyne/000001.bin", "velodyne/000003.bin"});
  folder.write("poses.txt", trajectory());
  folder.write("times.txt", "1000\n1000.5\n1001\n1002\n");  // A row for each frame number.
  folder.write("sequence.json", R"({"poses_are_lidar": true})");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(xs_of(sequence) == std::vector<double>{5, 20});
  CHECK(sequence.scans->load(1).time_s == 2.0);
  CHECK(sequence.motion->at(1001000000000)->translation().x() == 10.0);
  // Without times of scans, a row belongs to a frame number.
  std::filesystem::remove(folder / "times.txt");
  CHECK(xs_of(open_sequence(folder.text(), {})) == std::vector<double>{10, 30});
}
