// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/files/files.h"
#include "tests/datasets/clouds/record_files.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string pcd_head(int points, const std::string& encoding) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\n"
         "COUNT 1 1 1 1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + encoding + "\n";
}

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

// What PCL 1.13 wrote with savePCDFileBinaryCompressed for eight points (i, 2, -0.5) with
// intensity i mod 2: packed size 57, unpacked size 128, LZF stream.
const std::string kCompressedByPcl = from_hex(
    "3900000080000000"
    "010000400001803f200503400000402003008020"
    "0300a0200300c0200300e020034017e0140300bf"
    "203be01303200060"
    "5f2000e0070701803f");

std::string read_error(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  const auto path = folder.write(name, content);
  return message_of<DataError>([&] { read_cloud(path); });
}

void check_eight_points(const Cloud& cloud) {
  REQUIRE(cloud.points.size() == 8);
  REQUIRE(cloud.intensity.size() == 8);
  for (int i = 0; i < 8; ++i) {
    const auto at = static_cast<std::size_t>(i);
    CHECK(cloud.points[at] == Eigen::Vector3f(static_cast<float>(i), 2.0F, -0.5F));
    CHECK(cloud.intensity[at] == static_cast<float>(i % 2));
  }
}

}  // namespace

TEST_CASE("the three PCD encodings of one cloud read alike", "[cloud]") {
  const TemporaryFolder folder;
  std::string ascii = pcd_head(8, "ascii"), binary = pcd_head(8, "binary");
  for (int i = 0; i < 8; ++i) {
    ascii += std::to_string(i) + " 2 -0.5 " + std::to_string(i % 2) + "\n";
    binary += floats({static_cast<float>(i), 2.0F, -0.5F, static_cast<float>(i % 2)});
  }
  check_eight_points(read_cloud(folder.write("a.pcd", ascii)));
  check_eight_points(read_cloud(folder.write("b.pcd", binary)));
  check_eight_points(
      read_cloud(folder.write("c.pcd", pcd_head(8, "binary_compressed") + kCompressedByPcl)));
}

TEST_CASE("PCD fields may come in any order, type and count", "[cloud]") {
  const TemporaryFolder folder;
  const std::string head =
      "FIELDS z _ normal y x intensity\nSIZE 8 1 4 2 4 1\nTYPE F U F I F U\nCOUNT 1 3 2 1 1 1\n"
      "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  const std::string row = bytes_of<double>({3.5}) + "abc" + floats({9, 9}) +
                          bytes_of<std::int16_t>({-2}) + floats({1.25F}) + "\xC8";
  for (const auto& path : {folder.write("b.pcd", head + "binary\n" + row),
                           folder.write("a.pcd", head + "ascii\n3.5 1 2 3 9 9 -2 1.25 200\n")}) {
    const Cloud cloud = read_cloud(path);
    REQUIRE(cloud.points.size() == 1);
    CHECK(cloud.points[0] == Eigen::Vector3f(1.25F, -2.0F, 3.5F));
    CHECK(cloud.intensity == std::vector<float>{200.0F});
  }
  // LZF of 23 literal bytes: a control byte 22 and the bytes. Filler is left out of the block.
  const std::string columns = bytes_of<double>({3.5}) + floats({9, 9}) +
                              bytes_of<std::int16_t>({-2}) + floats({1.25F}) + "\xC8";
  REQUIRE(columns.size() == 23);
  const auto compressed =
      folder.write("c.pcd", head + "binary_compressed\n" + words({24, 23}) + "\x16" + columns);
  CHECK(read_cloud(compressed).points[0] == Eigen::Vector3f(1.25F, -2.0F, 3.5F));
  CHECK(read_cloud(compressed).intensity == std::vector<float>{200.0F});
}

TEST_CASE("PLY reads in ASCII and either endianness, with faces after the points", "[cloud]") {
  const TemporaryFolder folder;
  const auto head = [](const std::string& format) {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex 2\n" +
           "property float x\nproperty float y\nproperty double z\nproperty uchar intensity\n" +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  };
  std::string little, big;
  for (const float s : {1.0F, -4.0F}) {
    const std::vector<std::string> values = {floats({s}), floats({2.0F}), bytes_of<double>({0.5}),
                                             std::string(1, '\x07')};
    for (const std::string& value : values) {
      little += value;
      big += std::string(value.rbegin(), value.rend());
    }
  }
  for (const auto& path :
       {folder.write("a.ply", head("ascii") + "1 2 0.5 7\n-4 2 0.5 7\n3 0 1 1\n"),
        folder.write("l.ply", head("binary_little_endian") + little + "face"),
        folder.write("b.ply", head("binary_big_endian") + big + "face")}) {
    CAPTURE(path);
    const Cloud cloud = read_cloud(path);
    REQUIRE(cloud.points.size() == 2);
    CHECK(cloud.points[0] == Eigen::Vector3f(1.0F, 2.0F, 0.5F));
    CHECK(cloud.points[1] == Eigen::Vector3f(-4.0F, 2.0F, 0.5F));
    CHECK(cloud.intensity == std::vector<float>{7.0F, 7.0F});
  }
}

TEST_CASE("points far from the origin keep their digits when read from near them", "[cloud]") {
  const TemporaryFolder folder;
  const Eigen::Vector3d origin(691000.25, 5336000.5, 512.0);
  const Eigen::Vector3d far(691010.3734, 5335995.9326, 513.7341);
  const std::string head =
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS "
      "1\nDATA ";
  const auto written = [&](const std::string& name) {
    PointRecords records;
    for (const char* axis : {"x", "y", "z"}) records.layout.add(axis, 'F', 8);
    records.bytes.resize(sizeof far);
    records.width = 1;
    std::memcpy(records.row(0), far.data(), sizeof far);
    return folder.write(name, whole_file(name, records));
  };
  for (const auto& path :
       {folder.write("a.pcd", head + "ascii\n691010.3734 5335995.9326 513.7341\n"),
        folder.write("b.pcd", head + "binary\n" + bytes_of<double>({far.x(), far.y(), far.z()})),
        written("c.pcd"), written("d.ply")}) {
    CAPTURE(path);
    const Eigen::Vector3f near = read_cloud(path, origin).points.at(0);
    CHECK((near.cast<double>() - (far - origin)).norm() < 1e-5);
    CHECK(read_cloud(path).points.at(0) == far.cast<float>());  // In steps of half a metre.
  }
}

TEST_CASE("a damaged PCD body is named", "[cloud]") {
  check_says(read_error("a.pcd", pcd_head(3, "binary") + floats({1, 2, 3, 4, 5, 6})),
             {"a.pcd", "3 points of 16 bytes", "24 bytes follow", "after point 1"});
  check_says(read_error("a.pcd", pcd_head(2, "ascii") + "1 2 3 0\n1 abc 3 0\n"),
             {"line 13, column 3", "'abc'"});
  check_says(read_error("a.pcd", pcd_head(2, "ascii") + "1 2 3 0\n1 3 0\n"),
             {"line 13", "3 values", "announces 4"});
  check_says(read_error("a.pcd", pcd_head(2, "ascii") + "1 2 3 0\n"), {"2 points", "ends after 1"});
  check_says(read_error("a.pcd", pcd_head(1, "ascii") + "1 2 3 0\n1 2 3 0\n"),
             {"line 13", "more points than the 1"});
}

TEST_CASE("a damaged compressed block is named", "[cloud]") {
  const std::string head = pcd_head(8, "binary_compressed");
  check_says(read_error("a.pcd", head + kCompressedByPcl.substr(0, 40)),
             {"40 bytes follow", "65", "truncated"});
  check_says(read_error("a.pcd", head + "abc"), {"3 bytes follow", "truncated"});
  check_says(read_error("a.pcd", pcd_head(9, "binary_compressed") + kCompressedByPcl),
             {"announces 128 bytes", "take 144"});
  // A back reference to before the start: 0x20 0xFF = 3 bytes from 256 bytes back.
  check_says(read_error("a.pcd", head + words({2, 128}) + "\x20\xFF"), {"damaged"});
}

TEST_CASE("a header that cannot be is named", "[cloud]") {
  const auto header_error = [](std::string from, const std::string& to) {
    std::string content = pcd_head(1, "ascii") + "1 2 3 4\n";
    const std::size_t at = content.find(from);
    REQUIRE(at != std::string::npos);
    return read_error("h.pcd", content.replace(at, from.size(), to));
  };
  check_says(header_error("FIELDS x y", "FIELDS x q"), {"no field 'y'", "x, q, z, intensity"});
  check_says(header_error("SIZE 4 4 4 4", "SIZE 4 4 4"), {"SIZE has 3 values", "expected 4"});
  check_says(header_error("SIZE 4 4 4 4\n", ""), {"no SIZE entry"});
  check_says(header_error("COUNT 1 1 1 1", "COUNT 1 1 1 -1"), {"'-1'"});
  check_says(header_error("COUNT 1 1 1 1", "COUNT 2 1 1 1"), {"'x' with one value"});
  check_says(header_error("POINTS 1", "POINTS 7"), {"POINTS 7", "WIDTH x HEIGHT = 1"});
  check_says(header_error("DATA ascii", "DATA zip"), {"'zip'", "binary_compressed"});
  check_says(header_error("DATA ascii", "DATAS ascii"), {"'DATAS'", "Did you mean 'DATA'"});
  check_says(header_error("DATA ascii\n1 2 3 4\n", ""), {"header does not end", "DATA"});
  check_says(header_error("WIDTH 1", "WIDTH 1\nWIDTH 1"), {"WIDTH", "twice"});
  check_says(read_error("e.pcd", ""), {"header does not end"});
  check_says(read_error("e.ply", "ply\nformat ascii 1.0\n"), {"header does not end", "end_header"});
  check_says(read_error("e.ply",
                        "ply\nformat ascii 1.0\nelement vertex 1\n"
                        "property list uchar int x\nend_header\n"),
             {"line 4", "no list"});
  check_says(read_error("e.ply",
                        "ply\nelement vertex 0\nproperty float x\nproperty float y\n"
                        "property float z\nend_header\n"),
             {"no format line"});
}

TEST_CASE("counts far beyond the file are refused without being allocated", "[cloud]") {
  for (const char* encoding : {"ascii", "binary"}) {
    std::string content = pcd_head(1, encoding);
    for (const std::string entry : {"WIDTH 1", "POINTS 1"}) {
      content.replace(content.find(entry), entry.size(),
                      entry.substr(0, entry.size() - 1) + "4000000000");
    }
    check_says(read_error("big.pcd", content), {"4,000,000,000"});
  }
  check_says(read_error("big.ply",
                        "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty "
                        "float x\nproperty float y\nproperty float z\nend_header\n"),
             {"4,000,000,000"});
}

TEST_CASE("any cut and any flipped byte gives points or a DataError", "[cloud]") {
  const std::string ply =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const std::vector<std::string> whole = {
      "ply\nformat ascii 1.0\n" + ply + "1 2 3\n4 5 6\n",
      "ply\nformat binary_little_endian 1.0\n" + ply + floats({1, 2, 3, 4, 5, 6}),
      pcd_head(2, "ascii") + "1 2 3 0\n4 5 6 1\n",
      pcd_head(2, "binary") + floats({1, 2, 3, 0, 4, 5, 6, 1}),
      pcd_head(8, "binary_compressed") + kCompressedByPcl,
  };
  for (const std::string& content : whole) {
    const std::string name = content.starts_with("ply") ? "x.ply" : "x.pcd";
    read_cut_and_flipped(name, content, 1, [](const std::filesystem::path& path) {
      const std::size_t points = read_cloud(path).points.size();
      CHECK(points <= 99);  // A flipped digit of POINTS and WIDTH at most.
    });
  }
}

TEST_CASE("VIEWPOINT is a pose of its own and never moves the points", "[cloud]") {
  const TemporaryFolder folder;
  std::string content = pcd_head(1, "ascii") + "1 2 3 4\n";
  const std::string identity = "VIEWPOINT 1 2 3 1 0 0 0";
  // w = z = sqrt(1/2): a quarter turn about z takes x to y.
  content.replace(content.find(identity), identity.size(),
                  "VIEWPOINT 1 2 3 0.70710678 0 0 0.70710678");
  const auto path = folder.write("a.pcd", content);
  CHECK(read_cloud(path).points[0] == Eigen::Vector3f(1, 2, 3));
  CHECK((read_viewpoint(path) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm() < 1e-7);

  const auto error = [&](const std::string& viewpoint) {
    std::string text = pcd_head(1, "ascii");
    text.replace(text.find(identity), identity.size(), viewpoint);
    const auto bad = folder.write("bad.pcd", text);
    return message_of<DataError>([&] { read_viewpoint(bad); });
  };
  check_says(error("# none"), {"no VIEWPOINT", "tx ty tz qw qx qy qz"});
  check_says(error("VIEWPOINT 0 0 0 0 0 0 0"), {"VIEWPOINT", "length 0"});
  check_says(error("VIEWPOINT 0 0 0 1 0 0"), {"VIEWPOINT has 6 values"});
  check_says(error("VIEWPOINT 0 0 0 1 0 0 q"), {"VIEWPOINT value 7", "'q'"});
  check_says(error("VIEWPOINT nan 0 0 1 0 0 0"), {"not finite"});
}
