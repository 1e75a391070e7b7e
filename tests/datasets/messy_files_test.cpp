// SPDX-License-Identifier: MIT
// Folders as programs and people leave them: names, trajectories and single files.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/inspection/inspect.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "datasets/trajectories/pose_file.h"
#include "tests/datasets/open_folders.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::vector<std::string> names_of(const Sequence& sequence) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    names.push_back(sequence.scans->load(i).name);
  }
  return names;
}

std::string tum_row(const std::string& time, double x) {
  return time + " " + std::to_string(x) + " 0 0 0 0 0 1\n";
}

std::vector<double> xs_of(const PoseFile& file) {
  std::vector<double> xs;
  for (const PoseFile::Row& row : file.rows) xs.push_back(row.matrix(0, 3));
  return xs;
}

PoseFile read(const std::string& text, const std::string& name = "poses.txt") {
  const TemporaryFolder folder;
  return read_pose_file(folder.write(name, text));
}

}  // namespace

TEST_CASE("scans are in the order of the times in their names", "[files]") {
  const TemporaryFolder folder;
  // By runs of digits 0.1 would come behind 0.0 and 0.37 behind 0.2, but 0.2 behind 0.1037.
  write_scans(folder, {"0.0.bin", "0.1037.bin", "0.2.bin", "0.30125.bin"});
  folder.write("poses.txt",
               tum_row("0", 0) + tum_row("0.1037", 1) + tum_row("0.2", 2) + tum_row("0.30125", 3));
  folder.write("labels/0.2.label", words({252}));
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(names_of(sequence) == std::vector<std::string>{"0.0", "0.1037", "0.2", "0.30125"});
  CHECK(xs_of(sequence) == std::vector<double>{0, 1, 2, 3});
  CHECK(sequence.labels->labels(sequence.scans->load(2)) == std::vector<std::uint32_t>{252});
  CHECK(sequence.scans->load(3).time_s == 0.30125);

  // Of a clock that began elsewhere only the order counts, if there is a pose for each scan.
  folder.write("poses.txt",
               tum_row("1000", 0) + tum_row("1001", 1) + tum_row("1002", 2) + tum_row("1003", 3));
  CHECK(xs_of(open_sequence(folder.text(), {})) == std::vector<double>{0, 1, 2, 3});
}

TEST_CASE("times of poses are dates, repeated, unsorted, nan, and followed by comments",
          "[trajectories]") {
  CHECK(read("2014-11-11T17:22:35.5 1 0 0 0 0 0 1\n2014-11-11T17:22:36 2 0 0 0 0 0 1\n")
            .rows.at(1)
            .stamp == 1415726556'000000000);
  CHECK(*read("2014-11-11 17:22:35.5 1 0 0 0 0 0 1\n").rows.at(0).stamp % 1'000'000'000 ==
        500'000'000);
  CHECK(read("2014-11-11T17:22:35,1,0,0,0,0,0,1\n").format == "tum");
  CHECK(xs_of(read("1 4 0 0 0 0 0 1 # a key frame\n2 5 0 0 0 0 0 1\n")) ==
        std::vector<double>{4, 5});

  const PoseFile unsorted = read(tum_row("3", 3) + tum_row("1", 1) + tum_row("2", 2));
  CHECK(xs_of(unsorted) == std::vector<double>{1, 2, 3});
  check_says(unsorted.notes.at(0), {"1 row followed a later one", "sorted"});

  const PoseFile twice = read(tum_row("1", 1) + tum_row("2", 2) + tum_row("2", 2.1) +
                              tum_row("3", std::nan("")) + tum_row("4", 4));
  std::vector<std::string> notes;
  const auto poses = stamped_poses(twice, notes);
  REQUIRE(poses.size() == 3);
  CHECK(poses[1].T_world_body.translation().x() == Approx(2.05));
  REQUIRE(notes.size() == 2);
  check_says(notes[0], {"1 of 5 rows hold nan"});
  check_says(notes[1], {"1 of 5 rows have the time of the row before", "averaged"});
  // Motion capture that lost its target.
  CHECK(
      stamped_poses(read(tum_row("1", 1) + "2 0 0 0 0 0 0 0\n" + tum_row("3", 3)), notes).size() ==
      2);
  CHECK(read("nan nan nan nan nan nan nan nan\n1 2 0 0 0 0 0 1\n").rows.size() == 1);
  CHECK_FALSE(read("1 0 0 0 0 1 0 0 0 0 1 0\n0 0 0 0 0 0 0 0 0 0 0 0\n").rows.at(1).has_pose());
}

TEST_CASE("a row of nan leaves its scan without a pose where poses go by row", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin", "1.bin", "2.bin"});
  folder.write("poses.txt", kIdentityRow + "nan nan nan nan nan nan nan nan nan nan nan nan\n" +
                                "1 0 0 2 0 1 0 0 0 0 1 0\n");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(names_of(sequence) == std::vector<std::string>{"0", "2"});
  check_says(sequence.losses.at(0), {"1 of 3 scans have no pose", "nan"});
}

TEST_CASE("matrices may have a time in place of their last number", "[trajectories]") {
  const auto block = [](const char* x, const char* time) {
    return std::string("1,0,0,") + x + "\n0,1,0,0\n0,0,1,0\n0,0,0," + time + "\n";
  };
  const PoseFile blocks = read(block("1", "0.1") + block("2", "0.2"));
  CHECK(xs_of(blocks) == std::vector<double>{1, 2});
  CHECK(blocks.rows.at(1).stamp == 200'000'000);
  CHECK_FALSE(read(block("1", "1") + block("2", "1")).stamped());
  const PoseFile rows = read("1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 7\n1 0 0 6 0 1 0 0 0 0 1 0 0 0 0 8\n");
  CHECK(xs_of(rows) == std::vector<double>{5, 6});
  CHECK(rows.rows.at(0).stamp == 7'000'000'000);
}

TEST_CASE("rows of KITTI-360 belong to the frames that they name", "[trajectories]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0000000004.bin", "0000000005.bin", "0000000006.bin"});
  folder.write("poses.txt", "4 1 0 0 40 0 1 0 0 0 0 1 0\n6 1 0 0 60 0 1 0 0 0 0 1 0\n");
  const Sequence sequence = open_sequence(folder.text(), {});
  CHECK(xs_of(sequence) == std::vector<double>{40, 60});
  check_says(sequence.losses.at(0), {"1 of 3 scans have no pose", "2 frames from 4 to 6"});
  folder.write("poses.txt",
               "4 1 0 0 40 0 1 0 0 0 0 1 0 0 0 0 1\n"
               "5 1 0 0 50 0 1 0 0 0 0 1 0 0 0 0 1\n"
               "6 1 0 0 60 0 1 0 0 0 0 1 0 0 0 0 1\n");
  CHECK(xs_of(open_sequence(folder.text(), {})) == std::vector<double>{40, 50, 60});
}

TEST_CASE("tables of Boreas and Newer College are read", "[trajectories]") {
  const PoseFile boreas = read(
      "GPSTime,easting,northing,altitude,vel_east,vel_north,vel_up,roll,pitch,heading,angvel_z,"
      "angvel_y,angvel_x\n1606417097528152,10,20,30,1,2,3,0,0,1.5707963267948966,0,0,0\n",
      "lidar_poses.csv");
  CHECK(boreas.rows.at(0).stamp == 1606417097528152000);
  CHECK(boreas.rows[0].matrix.col(3) == Eigen::Vector3d(10, 20, 30));
  // pyboreas: the rotation of a heading h is that by -h about z.
  CHECK(boreas.rows[0].matrix(0, 1) == Approx(1.0));
  check_says(boreas.notes.at(0), {"pyboreas", "yaw"});
  const PoseFile college = read("#sec,nsec,x,y,z,qx,qy,qz,qw\n1583836591,82590976,1,2,3,0,0,0,1\n",
                                "registered_poses.csv");
  CHECK(college.rows.at(0).stamp == 1583836591082590976);
  CHECK(college.rows[0].matrix.col(3) == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("clocks that differ are a finding of their own", "[inspect]") {
  const TemporaryFolder folder;
  std::string times, poses;
  for (int i = 0; i < 10; ++i) {
    write_scans(folder, {std::to_string(i) + ".bin"});
    times += std::to_string(i) + "\n";
    poses += tum_row(std::to_string(i + 6), i);
  }
  folder.write("times.txt", times);
  folder.write("poses.txt", poses);
  const InspectionReport report = inspect_path(folder.text(), {});
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].check == "scans-without-poses");
  check_says(report.findings[0].sentence(), {"6 of 10 scans", "--time-offset 6.000000000"});
  SequenceOptions options;
  options.time_offset_s = 3.0;
  const Sequence some = open_sequence(folder.text(), options);
  REQUIRE(some.pose_gap);
  check_says(some.pose_gap->what, {"3 of 10 scans have no pose", "0.000000000 s to 9.000000000 s"});
}

TEST_CASE("a scan that cannot be read is left out on request, and said", "[files]") {
  const TemporaryFolder folder;
  write_scans(folder, {"0.bin", "1.bin", "2.bin", "3.bin"});
  folder.write("poses.txt", kIdentityRow + "1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n" +
                                "1 0 0 3 0 1 0 0 0 0 1 0\n");
  folder.write("1.bin", "cut off");
  const Sequence strict = open_sequence(folder.text(), {});
  check_says(message_of<DataError>([&] { (void)strict.scans->load(1); }),
             {"1.bin", "--skip-bad-scans"});
  SequenceOptions options;
  options.skip_bad_scans = true;
  const Sequence sequence = open_sequence(folder.text(), options);
  CHECK(xs_of(sequence) == std::vector<double>{0, 2, 3});
  CHECK(names_of(sequence) == std::vector<std::string>{"0", "2", "3"});
  REQUIRE(sequence.record().losses.size() == 1);
  check_says(sequence.record().losses[0], {"1 of 4 scans cannot be read (1.bin)", "7 bytes"});
  CHECK_THAT(sequence.record().losses[0], !Catch::Contains(folder.text()));
  folder.write("2.bin", "cut off");
  check_says(message_of<DataError>([&] { open_sequence(folder.text(), options); }),
             {"2 of 4 scans cannot be read (1.bin, 2.bin)", "expected fewer than half"});
}

TEST_CASE("fields of .pcd files are read as programs write them", "[clouds]") {
  const TemporaryFolder folder;
  const auto pcd = [&](const std::string& fields, const std::string& data) {
    return folder.write("a.pcd", "VERSION 0.7\n" + fields + "WIDTH 1\nHEIGHT 1\nPOINTS 1\n" + data);
  };
  const std::string four = "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n";
  const std::string row = floats({1, 2, 3, 4});
  const auto check = [](const std::filesystem::path& path) {
    const Cloud cloud = read_cloud(path);
    CHECK(cloud.points == std::vector<Eigen::Vector3f>{{1, 2, 3}});
    CHECK(cloud.intensity == std::vector<float>{4});
    CHECK(read_records(path).size() == 1);
  };
  check(pcd("FIELDS X Y Z Intensity\n" + four, "DATA binary\n" + row));
  check(pcd("FIELDS x y z _ intensity\nSIZE 4 4 4 1 4\nTYPE F F F U F\nCOUNT 1 1 1 0 1\n",
            "DATA binary\n" + row));
  check(pcd("FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE f f f f\n", "DATA binary\n" + row));
  check(pcd("FIELDS x y z intensity\n" + four, "DATA ascii\n1, 2, 3, 4\n"));
  check(pcd("FIELDS x y z intensity\n" + four, "DATA ascii\n1,2,3,4\n"));
  // Exact names come first.
  const auto both = pcd("FIELDS X Y Z x y z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n",
                        "DATA binary\n" + floats({9, 9, 9, 1, 2, 3}));
  CHECK(read_cloud(both).points == std::vector<Eigen::Vector3f>{{1, 2, 3}});
}

TEST_CASE("a .bin file of float64 is noticed, and its layout is named", "[clouds]") {
  const TemporaryFolder folder;
  for (const int width : {3, 4}) {
    std::vector<double> numbers;
    for (int i = 0; i < 200; ++i) {
      const double t = 0.37 * i;
      const std::vector<double> point = {30 * std::cos(t), 30 * std::sin(t), -1.7 + 0.001 * i, 20};
      numbers.insert(numbers.end(), point.begin(), point.begin() + width);
    }
    INFO(width);
    const auto path = folder.write("0.bin", bytes_of(numbers));
    const std::string layout = std::string("x:f8 y:f8 z:f8") + (width == 4 ? " intensity:f8" : "");
    check_says(message_of<DataError>([&] { check_bin_width({path}, {}); }),
               {"0.bin", "--point-layout \"" + layout + "\""});
    CHECK_NOTHROW(check_bin_width({path}, {layout}));
    CHECK(read_cloud(path, Eigen::Vector3d::Zero(), {layout}).points.size() == 200);
  }
}

TEST_CASE("formats that are not read are named with a program that converts them", "[files]") {
  for (const auto& [name, program] :
       std::vector<std::pair<std::string, std::string>>{{"a.e57", "CloudCompare"},
                                                        {"a.ptx", "CloudCompare"},
                                                        {"a.pts", "CloudCompare"},
                                                        {"a.laz", "laszip"},
                                                        {"a.pcd.gz", "gunzip"},
                                                        {"a.pcap", "ouster-cli"},
                                                        {"a.osf", "ouster-cli"},
                                                        {"a.xyz", "numpy.loadtxt"},
                                                        {"000001.txt", "numpy.loadtxt"},
                                                        {"000001.CSV", "numpy.loadtxt"},
                                                        {"a.feather", "pandas"}}) {
    INFO(name);
    const TemporaryFolder folder;
    const auto file = folder.write(name, "anything");
    for (const std::string& path : {file.string(), folder.text()}) {
      check_says(message_of<Error>([&] { open_sequence(path, {}); }), {name, program});
    }
  }
  const TemporaryFolder folder;
  const auto map = folder.write("map.las", "LASF");
  check_says(message_of<DataError>([&] { open_sequence(map.string(), {}); }),
             {"map.las: is one cloud", "a file for each scan", "pdal"});
}

TEST_CASE("dumps of programs are named with what makes a sequence of them", "[files]") {
  const auto error = [](const TemporaryFolder& folder, const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      std::filesystem::create_directories((folder / file).parent_path());
      folder.write(file, "anything");
    }
    return message_of<DataError>([&] { open_sequence(folder.text(), {}); });
  };
  const TemporaryFolder hdl, raw, sc;
  check_says(error(hdl, {"000000/cloud.pcd", "000000/data"}),
             {"hdl_graph_slam", "poses_of.py hdl-graph-slam " + hdl.text()});
  check_says(error(raw, {"oxts/data/0.txt", "velodyne_points/data/0.bin"}),
             {"KITTI raw", "poses_of.py kitti-raw " + raw.text()});
  check_says(error(sc, {"Scans/0.pcd", "odom_poses.txt", "optimized_poses.txt"}),
             {"Scans --poses FILE", "odom_poses.txt", "optimized_poses.txt"});
}

TEST_CASE("a row of nan at an end is continued for a moment", "[trajectories]") {
  std::vector<std::string> notes;
  const auto poses = stamped_poses(
      read(tum_row("0", std::nan("")) + tum_row("0.1", 1) + tum_row("0.2", 2)), notes);
  REQUIRE(poses.size() == 3);
  CHECK(poses[0].stamp == 0);
  CHECK(poses[0].T_world_body.translation().x() == Approx(0.0).margin(1e-9));
  CHECK(stamped_poses(read(tum_row("0", std::nan("")) + tum_row("1", 1) + tum_row("2", 2)), notes)
            .size() == 2);
}

TEST_CASE("scans in a folder below their poses are named with the options that open them") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scans");
  folder.write("scans/0.bin", floats({1.0F, 2.0F, 3.0F, 0.5F}));
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const std::string scans = (folder / "scans").string(), poses = (folder / "poses.txt").string();
  check_says(message_of<DataError>([&] { (void)open_sequence(folder.text(), {}); }),
             {"has scans: use " + scans + " --poses " + poses});
  SequenceOptions options;
  options.poses = poses;
  CHECK(open_sequence(scans, options).scans->size() == 1);
}
