// SPDX-License-Identifier: MIT
// Headers of clouds at their limits.
#include <catch2/catch.hpp>

#include "core/error.h"
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
