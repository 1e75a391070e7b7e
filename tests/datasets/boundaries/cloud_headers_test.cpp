// SPDX-License-Identifier: MIT
// Headers of clouds at their limits.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/cloud_header.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

CloudHeader pcd(const std::string& text) {
  return parse_pcd_header(text, "a.pcd");
}

CloudHeader ply(const std::string& text) {
  return parse_ply_header(text, "a.ply");
}

std::string pcd_says(const std::string& text) {
  return message_of<DataError>([&] { pcd(text); });
}

std::string ply_says(const std::string& text) {
  return message_of<DataError>([&] { ply(text); });
}

const std::string kTypes = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";

std::string sized(const std::string& width, const std::string& height) {
  return kTypes + "WIDTH " + width + "\nHEIGHT " + height + "\nDATA ascii\n";
}

std::string ply_of(const std::string& lines) {
  return "ply\nformat ascii 1.0\n" + lines +
         "property float x\nproperty float y\nproperty float z\nend_header\n";
}

}  // namespace

TEST_CASE("a PCD header needs no COUNT, no POINTS and no VIEWPOINT", "[header]") {
  const CloudHeader header =
      pcd("\n#comment\n \nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 2\nDATA ascii\n1");
  REQUIRE(header.fields.size() == 3);
  for (const PointField& field : header.fields) CHECK(field.count == 1);
  CHECK(header.row_bytes() == 12);
  CHECK(header.points == 6);
  CHECK(header.body_line == 10);
  CHECK_FALSE(header.big_endian);
  CHECK(header.points_end_the_file);
  CHECK_FALSE(header.viewpoint);
}

TEST_CASE("a PCD header has all seven numbers of its viewpoint", "[header]") {
  const CloudHeader header = pcd("VIEWPOINT 1 2 3 4 5 6 7\n" + sized("0", "1"));
  REQUIRE(header.viewpoint);
  for (int i = 0; i < 7; ++i) CHECK((*header.viewpoint)[i] == i + 1);
  check_says(pcd_says("VIEWPOINT a 2 3 4 5 6 7\n" + sized("0", "1")), {"VIEWPOINT value 1, 'a'"});
}

TEST_CASE("counts of a PCD header end where 32 bits do", "[header]") {
  CHECK(pcd(sized("4294967295", "1")).points == 4294967295U);
  CHECK(pcd(sized("0", "0")).points == 0);
  check_says(pcd_says(sized("4294967296", "1")), {"'4294967296' is not a number that is valid"});
  check_says(pcd_says(sized("65536", "65536")), {"4,294,967,296 points of 12 bytes"});
  check_says(pcd_says(sized("-1", "1")), {"'-1'"});
  CHECK(ply(ply_of("element vertex 4294967295\n")).points == 4294967295U);
  CHECK(ply(ply_of("element vertex 0\n")).points == 0);
  check_says(ply_says(ply_of("element vertex 4294967296\n")), {"header line 3", "'4294967296'"});
}

TEST_CASE("a field has at most 65,536 values, and a point at most a megabyte", "[header]") {
  const auto with_counts = [](const std::string& last) {
    return "FIELDS x y z a b c\nSIZE 4 4 4 8 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 65536 65536 " +
           last + "\nWIDTH 0\nHEIGHT 1\nDATA binary\n";
  };
  // 12 + 8 * 65536 + 4 * 65536 + 4 * 65533 = 2^20.
  CHECK(pcd(with_counts("65533")).row_bytes() == 1 << 20);
  check_says(pcd_says(with_counts("65534")), {"0 points of 1,048,580 bytes"});
  check_says(pcd_says(with_counts("65537")), {"'65537' is not a number that is valid"});
  check_says(pcd_says(with_counts("-1")), {"'-1' is not a number that is valid"});
  // A field of no values takes no bytes.
  CHECK(pcd(with_counts("0")).fields.size() == 5);
  CHECK(pcd(with_counts("0")).row_bytes() == 12 + 12 * 65536);
}

TEST_CASE("a header line has at most 65,536 bytes, however long the header is", "[header]") {
  const std::string line = "#" + std::string(65535, 'c');
  CHECK(pcd(line + "\n" + line + "\n" + sized("1", "1")).points == 1);
  check_says(pcd_says(line + "c\n" + sized("1", "1")), {"header does not end"});
  check_says(pcd_says(sized("1", "1").substr(0, 40)), {"header does not end", "'DATA'"});
}

TEST_CASE("a viewpoint is looked for in the first 65,536 bytes", "[header]") {
  const TemporaryFolder folder;
  const std::string rest = "VIEWPOINT 1 2 3 1 0 0 0\n" + sized("0", "1");
  const std::string fill = "#" + std::string(30000, 'c') + "\n";
  const auto of_bytes = [&](std::size_t bytes) {
    return fill + "#" + std::string(bytes - fill.size() - rest.size() - 2, 'c') + "\n" + rest;
  };
  REQUIRE(of_bytes(65536).size() == 65536);
  const Pose pose = read_viewpoint(folder.write("a.pcd", of_bytes(65536)));
  CHECK(pose.translation() == Eigen::Vector3d(1, 2, 3));
  const auto longer = folder.write("b.pcd", of_bytes(65537));
  check_says(message_of<DataError>([&] { read_viewpoint(longer); }), {"header does not end"});
}

TEST_CASE("types of PCD fields that cannot be are named", "[header]") {
  const auto with = [](const std::string& size, const std::string& type) {
    return pcd_says("FIELDS x y z\nSIZE 4 4 " + size + "\nTYPE F F " + type +
                    "\nWIDTH 1\nHEIGHT 1\nDATA ascii\n");
  };
  check_says(with("4", "FX"), {"field 'z' is TYPE FX SIZE 4"});
  for (const char* size : {"3", "5", "6", "7"}) {
    check_says(with(size, "I"), {"field 'z' is TYPE I"});
    check_says(with(size, "U"), {"field 'z' is TYPE U"});
    check_says(with(size, "F"), {"field 'z' is TYPE F"});
  }
  check_says(with("2", "F"), {"TYPE F SIZE 2"});
  check_says(with("1", "F"), {"TYPE F SIZE 1"});
  check_says(with("8", "Q"), {"TYPE Q SIZE 8"});
  check_says(with("9", "I"), {"'9' is not a number"});
  check_says(with("0", "I"), {"'0' is not a number"});
  check_says(pcd_says("SIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n"),
             {"no FIELDS entry"});
  check_says(pcd_says("WIDTH 1\nHEIGHT 1\nDATA ascii\n"), {"no FIELDS entry"});
}

TEST_CASE("what is no entry of a header is told with its first 40 letters", "[header]") {
  const std::string name(40, 'Q');
  check_says(pcd_says(name + "R 1\n" + sized("1", "1")), {"header line 1: '" + name + "' is no"});
  check_says(ply_says(ply_of(name + "R 1\n")), {"header line 3: '" + name + "' is no"});
}

TEST_CASE("each type of a PLY property has its size and sign under both names", "[header]") {
  struct Type {
    std::string name, other;
    char type;
    int size;
  };
  for (const Type& known : std::vector<Type>{{"char", "int8", 'I', 1},
                                             {"uchar", "uint8", 'U', 1},
                                             {"short", "int16", 'I', 2},
                                             {"ushort", "uint16", 'U', 2},
                                             {"int", "int32", 'I', 4},
                                             {"uint", "uint32", 'U', 4},
                                             {"float", "float32", 'F', 4},
                                             {"double", "float64", 'F', 8}}) {
    for (const std::string& name : {known.name, known.other}) {
      const CloudHeader header = ply(ply_of("element vertex 1\nproperty " + name + " first\n"));
      REQUIRE(header.fields.size() == 4);
      CHECK(header.fields[0].name == "first");
      CHECK(header.fields[0].type == known.type);
      CHECK(header.fields[0].size == known.size);
      CHECK(header.fields[0].count == 1);
    }
  }
}

TEST_CASE("a PLY header may have blank lines and comments, and knows where it ends", "[header]") {
  const std::string text = ply_of("\ncomment by hand\nobj_info none\nelement vertex 2\n");
  const CloudHeader header = ply(text + "1 2 3\n");
  CHECK(header.points == 2);
  CHECK(header.body_offset == text.size());
  CHECK(header.body_line == 11);
  CHECK(header.encoding == CloudEncoding::kAscii);
  CHECK_FALSE(header.big_endian);
  CHECK_FALSE(header.points_end_the_file);
}

TEST_CASE("PLY lines that cannot be are named", "[header]") {
  const std::string vertex = "element vertex 1\n";
  check_says(ply_says("ply x\n" + ply_of(vertex)), {"header line 1", "expected 'ply'"});
  check_says(ply_says("\n" + ply_of(vertex)), {"header line 1", "expected 'ply'"});
  check_says(ply_says(ply_of("element vertex\n")), {"header line 3", "'vertex' once"});
  check_says(ply_says(ply_of(vertex + vertex)), {"header line 4", "'vertex' once"});
  check_says(ply_says(ply_of("element face 1\nproperty list float int a\n" + vertex)),
             {"header line 4", "'property list TYPE TYPE NAME'"});
  check_says(ply_says(ply_of("")), {"header line 3", "property before any element"});
  for (const char* property : {"property float", "property float a b", "property half a"}) {
    check_says(ply_says(ply_of(vertex + property + "\n")), {"header line 4", "no list"});
  }
  for (const char* format : {"format ascii", "format", "format ascii 1.0 x", "format text 1.0"}) {
    check_says(ply_says("ply\n" + std::string(format) + "\n" + vertex),
               {"header line 2", "expected 'format ascii 1.0'"});
  }
  check_says(ply_says("ply\nformat ascii 1.0\nend_header\n"),
             {"has no points", "'element vertex COUNT'"});
}
