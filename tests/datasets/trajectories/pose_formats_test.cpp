// SPDX-License-Identifier: MIT
// One pose, a quarter turn about z at (1, 2, 3), in each form of file.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/trajectories/pose_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

const std::string kQuarter = "0 -1 0 1 1 0 0 2 0 0 1 3";
const std::string kHalf = "0.7071067811865476";  // cos and sin of an eighth turn.
constexpr Nanoseconds kStamp = 1317384506400000123;

PoseFile read(const std::string& name, const std::string& content,
              const std::optional<std::string>& format = std::nullopt) {
  const TemporaryFolder folder;
  return read_pose_file(folder.write(name, content), {format});
}

std::string error_of(const std::string& content, const std::optional<std::string>& format = {},
                     const std::string& name = "poses.txt") {
  return message_of<DataError>([&] { read(name, content, format); });
}

/// Pose `row` is the quarter turn.
void check_quarter(const PoseFile& file, const std::string& format, std::size_t row = 0) {
  INFO(file.format);
  CHECK(file.format == format);
  REQUIRE(file.rows.size() > row);
  const Pose pose = rigid_pose(file, row);
  CHECK((pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm() < 1e-5);
  CHECK((pose * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1, 2, 4)).norm() < 1e-5);
}

}  // namespace

TEST_CASE("matrices stand in rows, in blocks, with and without times", "[trajectories]") {
  check_quarter(read("p.txt", kQuarter + "\n" + kIdentityRow), "kitti");
  check_quarter(read("p.csv", "0,-1,0,1,1,0,0,2,0,0,1,3\n"), "kitti");
  check_quarter(read("p.txt", kQuarter + " 0 0 0 1\n"), "matrix");
  check_quarter(read("p.txt",
                     "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n\n"
                     "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n"),
                "matrix", 1);
  const PoseFile mulran = read("p.csv", "1317384506400000123,0,-1,0,1,1,0,0,2,0,0,1,3\n");
  check_quarter(mulran, "kitti");
  CHECK(mulran.rows[0].stamp == kStamp);
  const PoseFile stamped = read("p.txt", "1317384506.400000123 " + kQuarter + " 0 0 0 1\n");
  check_quarter(stamped, "matrix");
  CHECK(stamped.rows[0].stamp == kStamp);
}

TEST_CASE("TUM and EuRoC are told apart", "[trajectories]") {
  const PoseFile tum = read(
      "p.txt", "# timestamp x y z\n1317384506.400000123 1 2 3 0 0 " + kHalf + " " + kHalf + "\n");
  check_quarter(tum, "tum");
  CHECK(tum.rows[0].stamp == kStamp);
  // ORB-SLAM3 writes nanoseconds between blanks, in TUM's order.
  const PoseFile orb =
      read("p.txt", "1317384506400000123.0 1 2 3 0 0 " + kHalf + " " + kHalf + "\n");
  check_quarter(orb, "tum");
  CHECK(orb.rows[0].stamp == kStamp);
  const std::string wxyz = "1317384506400000123,1,2,3," + kHalf + ",0,0," + kHalf;
  check_quarter(read("p.csv", wxyz + "\n"), "euroc");
  const PoseFile whole = read("data.csv",
                              "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
                              "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],v_RS_R_x [m s^-1]"
                              ",v_RS_R_y,v_RS_R_z,b_w_RS_S_x,b_w_RS_S_y,b_w_RS_S_z,"
                              "b_a_RS_S_x,b_a_RS_S_y,b_a_RS_S_z\n" +
                                  wxyz + ",9,9,9,9,9,9,9,9,9\n");
  check_quarter(whole, "csv");
  CHECK(whole.rows[0].stamp == kStamp);
  check_quarter(read("data.csv", wxyz + ",9,9,9,9,9,9,9,9,9\n"), "euroc");
  // TUM's order between commas: seconds, and the quaternion of a vehicle on a plane.
  check_quarter(read("p.csv", "1317384506.4,1,2,3,0,0," + kHalf + "," + kHalf + "\n"), "tum");
}

TEST_CASE("an order that cannot be told is an error that names the flag", "[trajectories]") {
  const std::string both = "1317384506400000123,1,2,3,0,0," + kHalf + "," + kHalf + "\n";
  check_says(error_of(both), {"--pose-format tum", "--pose-format euroc"});
  check_quarter(read("p.csv", both, "tum"), "tum");
  const std::string first = "1317384506.4,1,2,3," + kHalf + ",0,0," + kHalf + "\n";
  check_says(error_of(first), {"--pose-format tum", "--pose-format euroc"});
  const PoseFile euroc = read("p.csv", first, "euroc");
  check_quarter(euroc, "euroc");
  CHECK(euroc.rows[0].stamp == 1317384506400000000);
}

TEST_CASE("columns with names stand in any order", "[trajectories]") {
  const PoseFile file = read("p.csv", "frame,qw,qx,qy,qz,z,y,x,sec,nsec\nmap," + kHalf + ",0,0," +
                                          kHalf + ",3,2,1,1317384506,400000123\n");
  check_quarter(file, "csv");
  CHECK(file.rows[0].stamp == kStamp);
  check_quarter(read("p.csv", "time;tx;ty;tz;roll [deg];pitch [deg];yaw [deg]\n5;1;2;3;0;0;90\n"),
                "csv");
  check_quarter(read("p.csv", "t,x,y,z,roll,pitch,yaw\n5,1,2,3,0,0,1.5707963267948966\n"), "csv");
  const PoseFile degrees = read("p.csv", "t,x,y,z,roll,pitch,yaw\n5,1,2,3,0,0,90\n");
  check_quarter(degrees, "csv");
  check_says(degrees.notes.at(0), {"degrees"});
  // rostopic echo -p.
  const PoseFile topic = read(
      "p.csv",
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.pose.position.x,"
      "field.pose.pose.position.y,field.pose.pose.position.z,field.pose.pose.orientation.x,"
      "field.pose.pose.orientation.y,field.pose.pose.orientation.z,field.pose.pose.orientation.w,"
      "field.twist.twist.linear.x\n9,1,1317384506400000123,odom,1,2,3,0,0," +
          kHalf + "," + kHalf + ",7\n");
  check_quarter(topic, "csv");
  CHECK(topic.rows[0].stamp == kStamp);
  check_says(error_of("time,x,y\n1,2,3\n"), {"names no columns for a pose", "qx qy qz qw"});
  check_says(error_of("sec,nsec,x,y,z,qx,qy,qz,qw\n5.5,0,1,2,3,0,0,0,1\n"),
             {"line 2", "whole seconds"});
  check_says(error_of("t,x,y,z,qx,qy,qz,qw\n5,1,2,3,0,0,0,1\n6,1,2\n"), {"line 3", "expected 8"});
}

TEST_CASE("what SLAM programs write is read", "[trajectories]") {
  std::string zeros;
  for (int i = 0; i < 18; ++i) zeros += "0.0 ";
  const PoseFile fast_lio = read("pos_log.txt", "0.1 0 0 1.5707963 1 2 3 " + zeros + "\r\n");
  check_quarter(fast_lio, "fast-lio");
  CHECK(fast_lio.rows[0].stamp == 100'000'000);
  check_quarter(read("pose.json", "1 2 3 " + kHalf + " 0 0 " + kHalf + "\n"), "hba");
  check_says(error_of("1 2 3 " + kHalf + " 0 0 " + kHalf + "\n"),
             {"7 numbers", "--pose-format hba"});
  const PoseFile g2o = read("graph.g2o",
                            "VERTEX_SE3:QUAT 7 9 9 9 0 0 0 1\nEDGE_SE3:QUAT 3 7 1\n"
                            "VERTEX_SE3:QUAT 3 1 2 3 0 0 " +
                                kHalf + " " + kHalf + "\n");
  check_quarter(g2o, "g2o");  // Vertex 3 comes before vertex 7.
  CHECK_FALSE(g2o.stamped());
  check_says(g2o.notes.at(0), {"no times"});
  // CT-ICP leaves out the blank between a time of -1 and qx, which is 0 or -0.6 here.
  const std::string end = "0 0.2 0 -10 0 0 1 9 9 9\n";
  check_quarter(read("traj.txt", "0 0.1 0 -10 0 " + kHalf + " " + kHalf + " 1 2 3 " + end),
                "ct-icp");
  const PoseFile turned = read("traj.txt", "0 0.1 0 -1-0.6 0 0 0.8 1 2 3 " + end);
  CHECK(rigid_pose(turned, 0).linear()(2, 1) == Approx(-0.96));
  check_quarter(read("traj.txt",
                     "0 0.1 0 -1 0 0 " + kHalf + " " + kHalf + " 1 2 3 0 0.2 0 -1 0 0 0 1 9 9 9\n"),
                "ct-icp");
  check_says(error_of("0 0.1 0 -10 0 0 0.5 1 2 3 " + end), {"line 1", "'-10'", "CT-ICP"});
}

TEST_CASE("LIO-SAM's key poses are read from a cloud", "[trajectories]") {
  const std::string head =
      "VERSION 0.7\nFIELDS x y z intensity roll pitch yaw time\nSIZE 4 4 4 4 4 4 4 8\nTYPE F F F F "
      "F F F F\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n";
  const PoseFile file = read("transformations.pcd", head +
                                                        "1 2 3 0 0 0 1.5707963 1317384506.4\n"
                                                        "1 2 3 1 0 0 1.5707963 1317384506.9\n");
  check_quarter(file, "lio-sam", 1);
  CHECK(file.place(1).ends_with("transformations.pcd: pose 2"));
  CHECK(*file.rows[1].stamp - *file.rows[0].stamp == Approx(5e8).epsilon(1e-6));
  const std::string positions =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS "
      "1\n"
      "DATA ascii\n1 2 3\n";
  check_says(error_of(positions, {}, "trajectory.pcd"), {"positions only", "transformations.pcd"});
  std::string coarse = head;
  coarse.replace(coarse.find("4 4 4 8"), 7, "4 4 4 4");
  check_says(
      error_of(coarse + "1 2 3 0 0 0 0 1317384506.4\n1 2 3 0 0 0 0 1317384506.9\n", {}, "t.pcd"),
      {"float32", "float64"});
}

TEST_CASE("arrays of matrices are read", "[trajectories]") {
  const auto npy = [](const std::string& shape, const std::vector<double>& values,
                      const std::string& by_columns = "False") {
    std::string head =
        "{'descr': '<f8', 'fortran_order': " + by_columns + ", 'shape': " + shape + ", }";
    head.resize(117, ' ');
    return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + head + "\n" + bytes_of(values);
  };
  const std::vector<double> pose = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
  check_quarter(read("poses.npy", npy("(1, 4, 4)", pose)), "npy");
  check_quarter(read("poses.npy", npy("(1, 3, 4)", {pose.begin(), pose.begin() + 12})), "npy");
  // Fortran order: of two poses, the first numbers of both, then those of the next row.
  std::vector<double> rows_first, columns;
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      const double other = row == column ? 1 : 0;
      rows_first.insert(rows_first.end(), {other, pose[4 * row + column]});
    }
  }
  for (std::size_t k = 0; k < 12; ++k) {
    const double other = k % 5 == 0 ? 1 : 0;
    columns.insert(columns.end(), {other, pose[k]});
  }
  check_quarter(read("poses.npy", npy("(2, 3, 4)", rows_first, "True")), "npy", 1);
  check_quarter(read("poses.npy", npy("(2, 12)", columns, "True")), "npy", 1);
  check_says(error_of(npy("(2, 4, 4)", pose), {}, "p.npy"),
             {"2 poses", "bytes for 1", "truncated"});
  check_says(error_of(npy("(4, 4)", pose), {}, "p.npy"), {"an array of 4 x 4"});
  check_says(error_of(npy("(1000000000, 4, 4)", pose), {}, "p.npy"), {"bytes for 1"});
  check_says(error_of(npy("(1000000000000, 4, 4)", pose), {}, "p.npy"), {"not a count"});
  check_says(error_of("\x93NUMPY\x01", {}, "p.npy"), {"p.npy: is not a .npy file"});
}

TEST_CASE("poses from the world to the body are turned round", "[trajectories]") {
  // The inverse of the quarter turn at (1, 2, 3): R^T, -R^T t = (-2, 1, -3).
  const std::string inverse = "0 1 0 -2 -1 0 0 1 0 0 1 -3\n";
  check_quarter(read("p.txt", inverse, "inverse"), "kitti");
  check_quarter(read("p.txt", inverse, "kitti:inverse"), "kitti");
}

TEST_CASE("formats have names, and a wrong one is told", "[trajectories]") {
  CHECK(pose_format_names().size() == 11);
  check_says(message_of<UsageError>([] { read("p.txt", kIdentityRow, "tumm"); }),
             {"no pose format 'tumm'", "'tum'"});
  check_says(error_of(kIdentityRow, "tum"), {"line 1: 12 numbers", "format tum"});
  check_says(error_of(std::string("\0\1\2", 3)), {"neither text"});
  check_says(error_of("1 2 3 4 5\n"), {"line 1: 5 numbers", "`raymoval list pose-formats`"});
}
