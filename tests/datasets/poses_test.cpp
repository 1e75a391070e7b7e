// SPDX-License-Identifier: MIT
#include "datasets/clouds/poses.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"
#include "core/text.h"
#include "datasets/trajectories/pose_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string pose_error(const std::string& content, std::size_t row = 0) {
  const TemporaryFolder folder;
  const auto path = folder.write("poses.txt", content);
  return message_of<DataError>([&] { rigid_pose(read_pose_file(path), row); });
}

}  // namespace

TEST_CASE("KITTI rows are 3 x 4 matrices row by row", "[poses]") {
  const TemporaryFolder folder;
  // A rotation by 90 degrees about z, then a shift by (1, 2, 3): x maps to y, so (1, 0, 0) ends at
  // (1, 3, 3).
  const auto path =
      folder.write("p.txt", "# made by hand\n\n0 -1 0 1 1 0 0 2 0 0 1 3\r\n" + kIdentityRow);
  const PoseFile file = read_pose_file(path);
  REQUIRE(file.rows.size() == 2);
  CHECK(file.rows[0].line == 3);
  CHECK(file.rows[1].line == 4);
  const Pose pose = rigid_pose(file, 0);
  CHECK((pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm() < 1e-15);
  CHECK(rigid_pose(file, 1).matrix() == Eigen::Matrix4d::Identity());
}

TEST_CASE("TUM and KITTI rows of one pose are equal", "[poses]") {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::string kitti, tum;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized();
    const Eigen::Vector3d t(normal(random), normal(random), normal(random));
    const Eigen::Matrix3d R = q.toRotationMatrix();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) kitti += number_text(R(r, c)) + " ";
      kitti += number_text(t[r]) + (r == 2 ? "\n" : " ");
    }
    tum += number_text(100.0 + i);
    for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      tum += " " + number_text(v);
    }
    tum += "\n";
  }
  const PoseFile a = read_pose_file(folder.write("kitti.txt", kitti));
  const PoseFile b = read_pose_file(folder.write("tum.txt", tum));
  REQUIRE(a.rows.size() == 20);
  REQUIRE(b.rows.size() == 20);
  CHECK_FALSE(a.stamped());
  CHECK(b.rows[3].stamp == 103'000'000'000);
  CHECK(a.format == "kitti");
  CHECK(b.format == "tum");
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK((rigid_pose(a, i).matrix() - rigid_pose(b, i).matrix()).norm() < 1e-12);
  }
}

TEST_CASE("what is no rotation is named with its line and deviation", "[poses]") {
  // diag(1.01, 1, 1): R^T R - I = diag(0.0201, 0, 0).
  check_says(pose_error(kIdentityRow + "1.01 0 0 0 0 1 0 0 0 0 1 0\n", 1),
             {"poses.txt: line 2", "0.0201", "not a rotation"});
  // A mirror is orthogonal but turns a right hand into a left one.
  check_says(pose_error("1 0 0 0 0 1 0 0 0 0 -1 0\n"), {"line 1", "det R = -1"});
  check_says(pose_error("1 0 0 nan 0 1 0 0 0 0 1 0\n"), {"line 1", "not finite"});
  check_says(pose_error("1 0 0 0 0 inf 0 0 0 0 1 0\n"), {"line 1", "not finite"});
  check_says(pose_error("0 0 0 0 0 0 0 2\n"), {"line 1", "length 2", "quaternion"});
  check_says(pose_error("0 0 0 0 0 0 0 0\n"), {"line 1", "length 0"});
  check_says(pose_error("0 0 0 0 0 0 0 0.5\n"), {"line 1", "length 0.5"});
  check_says(pose_error("0 0 0 0 0 0 0 0 0 0 0 0\n"), {"line 1", "rotation"});
  check_says(pose_error("0 nan 0 0 0 0 0 1\n"), {"line 1", "not finite"});
}

TEST_CASE("garbage in a pose file is named by line and column", "[poses]") {
  check_says(pose_error(kIdentityRow + "1 0 0 0 0 1x 0 0 0 0 1 0\n"),
             {"poses.txt: line 2, column 11", "'1x'"});
  check_says(pose_error("1;0,0\n"), {"line 1, column 3", "'0,0'", "semicolons"});
  check_says(pose_error("1 0 0 0 0 1 0 0 0 0 1\n"),
             {"line 1", "11 numbers", "12 (KITTI", "8 (TUM"});
  check_says(pose_error(kIdentityRow + "1 0 0\n"), {"line 2", "3 numbers", "expected 12 as in"});
  check_says(pose_error("# nothing\n\n"), {"holds no pose"});
}

TEST_CASE("a calibration row is found by its key", "[poses]") {
  const TemporaryFolder folder;
  const auto good =
      folder.write("calib.txt", "P0: 7 0 6 0 0 7 1 0 0 0 1 0\nTr: 0 -1 0 1 0 0 -1 2 1 0 0 3\n");
  const Pose Tr = read_calibration(good, "Tr");
  CHECK(Tr.linear()(0, 1) == -1.0);
  CHECK(Tr.translation() == Eigen::Vector3d(1, 2, 3));
  const auto error = [&](const std::string& content) {
    const auto path = folder.write("bad.txt", content);
    return message_of<DataError>([&] { read_calibration(path, "Tr"); });
  };
  check_says(error("P0: 1\nTr_velo: 2\n"), {"no row 'Tr:'", "P0, Tr_velo", "poses_are_lidar"});
  check_says(error("Tr: 1 2 3\n"), {"line 1", "3 numbers", "expected 12"});
  check_says(error("\nTr: 1 0 o 0\n"), {"line 2, column 9", "'o'"});
  check_says(error("Tr: 2 0 0 0 0 1 0 0 0 0 1 0\n"), {"line 1: Tr", "not a rotation"});
}
