// SPDX-License-Identifier: MIT
// Files that are written in the form of the file that the points come from.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/files/files.h"
#include "datasets/clouds/format/deflate.h"
#include "datasets/clouds/format/point_layout.h"
#include "datasets/clouds/numpy/zip_archive.h"
#include "tests/datasets/clouds/record_files.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// Records whose reals are numbers: a text does not tell one NaN from another.
PointRecords readable_records(std::mt19937& random, bool with_gaps) {
  PointRecords made = random_records(random, with_gaps);
  for (const PointField& field : made.layout.fields) {
    if (field.type != 'F') continue;
    for (std::size_t i = 0; i < made.size(); ++i) {
      for (int at = 0; at < field.count; ++at) {
        if (std::isnan(made.value(i, field, at))) made.set_value(i, field, -0.0, at);
      }
    }
  }
  return made;
}

PointRecords written(const TemporaryFolder& folder, const std::string& name,
                     const PointRecords& records) {
  return read_records(folder.write(name, whole_file(name, records)));
}

void check_same(const PointRecords& read, const PointRecords& made) {
  REQUIRE(read.layout.fields.size() == made.layout.fields.size());
  for (const PointField& field : made.layout.fields) {
    INFO(field.text());
    CHECK(same_bytes(read, made, field.name == "a b" ? "a_b" : field.name, field.name));
  }
}

}  // namespace

TEST_CASE("text and compressed .pcd files stay what they are", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(21);
  for (int i = 0; i < 20; ++i) {
    PointRecords made = readable_records(random, true);
    made.form.text = i % 2 == 0;
    made.form.packed = !made.form.text;
    const PointRecords read = written(folder, "a.pcd", made);
    check_same(read, made);
    CHECK(read.form.text == made.form.text);
    CHECK(read.form.packed == made.form.packed);
  }
}

TEST_CASE("a compressed .pcd file may hold what cannot be packed, or nothing", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(22);
  PointRecords made;
  made.layout = parse_point_layout("x y z noise:u1[40]");
  made.form.packed = true;
  made.bytes.resize(500 * made.layout.row_bytes);
  for (std::byte& byte : made.bytes) byte = static_cast<std::byte>(random());
  made.width = made.size();
  CHECK(written(folder, "noise.pcd", made).bytes == made.bytes);
  made.bytes.clear();
  made.width = 0;
  CHECK(written(folder, "nothing.pcd", made).size() == 0);
}

TEST_CASE(".ply files keep text and the order of bytes", "[records]") {
  const TemporaryFolder folder;
  PointRecords made;
  made.layout = parse_point_layout("x:f8 y:f8 z:f8 ring:u2 offset:i4");
  made.bytes.resize(2 * made.layout.row_bytes);
  made.width = 2;
  made.set_value(0, made.layout.fields[0], 0.1);
  made.set_value(0, made.layout.fields[3], 513);
  made.set_value(1, made.layout.fields[4], -7);
  for (const bool text : {false, true}) {
    made.form.text = text;
    made.form.big_endian = !text;
    const std::string bytes = whole_file("a.ply", made);
    CHECK(bytes.find(text ? "format ascii 1.0" : "format binary_big_endian 1.0") !=
          std::string::npos);
    const PointRecords read = written(folder, "a.ply", made);
    CHECK(read.bytes == made.bytes);
    CHECK(read.form.text == text);
    CHECK(read.form.big_endian == !text);
  }
  made.form = {};
  CHECK(whole_file("a.ply", made).find("binary_little_endian") != std::string::npos);
}

TEST_CASE("values in a text read back as the same numbers", "[records]") {
  const TemporaryFolder folder;
  PointRecords made;
  made.layout = parse_point_layout("x y z t:u8 s:i1");
  made.bytes.resize(made.layout.row_bytes);
  made.width = 1;
  const float values[] = {0.1F, std::numeric_limits<float>::denorm_min(),
                          std::numeric_limits<float>::quiet_NaN()};
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  std::memcpy(made.row(0), values, sizeof values);
  std::memcpy(made.row(0) + 12, &most, sizeof most);
  made.set_value(0, made.layout.fields[4], -128);
  made.form.text = true;
  CHECK_THAT(whole_file("a.pcd", made),
             Catch::EndsWith("DATA ascii\n0.1 1e-45 nan 18446744073709551615 -128\n"));
  const PointRecords read = written(folder, "a.pcd", made);
  CHECK(std::memcmp(read.row(0), made.row(0), 8) == 0);
  CHECK(std::isnan(read.value(0, read.layout.fields[2])));
  CHECK(std::memcmp(read.row(0) + 12, made.row(0) + 12, 9) == 0);
}

TEST_CASE("archives of arrays and gzip are written as they were", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(23);
  PointRecords made = random_records(random);
  for (const bool packed : {false, true}) {
    made.form = {};
    made.form.packed = packed;
    made.form.array = "scan";
    const std::string archive = whole_file("a.npz", made);
    CHECK(zip_members(archive, "a.npz").at(0).method == (packed ? 8 : 0));
    CHECK(zip_members(archive, "a.npz").at(0).name == "scan.npy");
    const PointRecords read = written(folder, "a.npz", made);
    CHECK(read.layout == made.layout);
    CHECK(read.bytes == made.bytes);
    CHECK(read.form.array == "scan");
    CHECK(read.form.packed == packed);
  }
  made.form = {};
  const std::string plain = whole_file("a.npy", made);
  CHECK(unpack_gzip(whole_file("a.npy.gz", made), "a.npy.gz") == plain);
  CHECK(written(folder, "a.npy.gz", made).bytes == made.bytes);
}
