// SPDX-License-Identifier: MIT
// Points with all their fields, through every format and back.

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/field_names.h"
#include "tests/datasets/clouds/record_files.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

PointRecords round_trip(const std::filesystem::path& path, const PointRecords& records,
                        const RecordReading& reading = {}) {
  write_records(path, records);
  return read_records(path, reading);
}

}  // namespace

TEST_CASE("any layout goes through .pcd, .npy and .bin bit for bit", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const PointRecords made = random_records(random);
    const PointRecords npy = round_trip(folder / "a.npy", made);
    CHECK(npy.layout == made.layout);
    CHECK(npy.bytes == made.bytes);
    CHECK(format_losses("a.npy", made.layout).empty());

    const PointRecords pcd = round_trip(folder / "a.pcd", made);
    RecordLayout renamed = made.layout;
    for (PointField& field : renamed.fields) {
      if (field.name == "a b") field.name = "a_b";
    }
    CHECK(pcd.layout == renamed);
    CHECK(pcd.bytes == made.bytes);
    CHECK(format_losses("a.pcd", made.layout).size() == (renamed == made.layout ? 0 : 1));

    const PointRecords bin = round_trip(folder / "a.bin", made, {point_layout_text(made.layout)});
    CHECK(bin.layout.fields == renamed.fields);
    CHECK(bin.bytes == made.bytes);
    REQUIRE(format_losses("a.bin", made.layout).size() == 1);
    check_says(format_losses("a.bin", made.layout)[0], {point_layout_text(made.layout)});
  }
}

TEST_CASE("any layout goes through .ply value by value", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(8);
  for (int i = 0; i < 30; ++i) {
    const PointRecords made = random_records(random);
    const PointRecords ply = round_trip(folder / "a.ply", made);
    std::size_t told = 0;
    for (const PointField& field : made.layout.fields) {
      const bool wide = field.type != 'F' && field.size == 8;
      told += (wide ? 1U : 0U) + (field.count > 1 ? 1U : 0U) +
              (field.name == "a b" ? static_cast<std::size_t>(field.count) : 0U);
      for (int at = 0; at < field.count; ++at) {
        std::string name = field.name == "a b" ? "a_b" : field.name;
        if (field.count > 1) name += "_" + std::to_string(at);
        const PointField* found = ply.layout.find({name});
        REQUIRE(found != nullptr);
        CHECK(found->type == (wide ? 'F' : field.type));
        CHECK(found->size == field.size);
        for (std::size_t point = 0; point < made.size() && !wide; ++point) {
          CHECK(std::memcmp(ply.row(point) + found->offset,
                            made.row(point) + field.offset + at * field.size,
                            static_cast<std::size_t>(field.size)) == 0);
        }
      }
    }
    CHECK(format_losses("a.ply", made.layout).size() == told);
  }
}

TEST_CASE("the layout of a file is that of its records", "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(12);
  for (int i = 0; i < 5; ++i) {
    const PointRecords made = random_records(random);
    const RecordReading reading{point_layout_text(made.layout)};
    for (const char* name : {"a.pcd", "a.ply", "a.bin", "a.las", "a.npy"}) {
      CAPTURE(name);
      write_records(folder / name, made);
      CHECK(read_layout(folder / name, reading) == read_records(folder / name, reading).layout);
    }
  }
  // A head that is longer than usual.
  const std::string comment = "#" + std::string(5000, 'c') + "\n";
  const auto path = folder.write("b.pcd", comment +
                                              "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\n"
                                              "HEIGHT 1\nDATA ascii\n");
  CHECK(read_layout(path) == parse_point_layout("x y z"));
}

TEST_CASE("what PLY rounds is said, and is the nearest double", "[records]") {
  const TemporaryFolder folder;
  PointRecords records;
  records.layout = parse_point_layout("x y z t:u8");
  records.bytes.resize(records.layout.row_bytes);
  const std::uint64_t time = 1700000000123456789U;
  std::memcpy(records.bytes.data() + 12, &time, sizeof time);
  check_says(format_losses("a.ply", records.layout).at(0), {"'t'", "uint64 t", "2^53"});
  CHECK(column(round_trip(folder / "a.ply", records), "t") ==
        std::vector<double>{static_cast<double>(time)});
  for (const char* exact : {"a.pcd", "a.npy"}) {
    CHECK(same_bytes(round_trip(folder / exact, records), records, "t", "t"));
  }
}

TEST_CASE("a cloud in rows and its viewpoint stay as they are in .pcd, the rows in .npy",
          "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(9);
  PointRecords made = random_records(random);
  made.width = 3;
  made.height = 2;
  made.bytes.resize(6 * made.layout.row_bytes);
  made.viewpoint.emplace();
  *made.viewpoint << 0.1, -2, 3e300, 0.5, 0.5, 0.5, 0.5;
  const PointRecords pcd = round_trip(folder / "a.pcd", made);
  CHECK(pcd.width == 3);
  CHECK(pcd.height == 2);
  CHECK(pcd.viewpoint == made.viewpoint);
  const PointRecords npy = round_trip(folder / "a.npy", made);
  CHECK(npy.width == 3);
  CHECK(npy.height == 2);

  // Two pieces with two viewpoints are a map.
  PointRecordWriter writer(folder / "map.pcd");
  writer.start(made.layout);
  writer.add(made);
  made.viewpoint->x() = 7;
  writer.add(made);
  writer.finish();
  writer.commit();
  const PointRecords map = read_records(folder / "map.pcd");
  CHECK(map.width == 12);
  CHECK(map.height == 1);
  CHECK(*map.viewpoint == (Eigen::Matrix<double, 7, 1>() << 0, 0, 0, 1, 0, 0, 0).finished());
}

TEST_CASE("records written in pieces read back as one, from when they have their name",
          "[records]") {
  const TemporaryFolder folder;
  std::mt19937 random(31);
  const PointRecords made = random_records(random);
  for (const char* name : {"a.pcd", "a.ply", "a.npy"}) {
    PointRecordWriter writer(folder / name);
    writer.start(made.layout);
    PointRecords piece = made;
    for (std::size_t i = 0; i < made.size(); i += 3) {
      const std::size_t count = std::min<std::size_t>(3, made.size() - i);
      piece.bytes.assign(made.row(i), made.row(i) + count * made.layout.row_bytes);
      piece.width = count;
      writer.add(piece);
    }
    writer.finish();
    CHECK_FALSE(std::filesystem::exists(folder / name));
    Replacements together;
    writer.commit_with(together);
    together.commit();
    CHECK(read_records(folder / name).size() == made.size());
    if (std::string(name) == "a.npy") CHECK(read_records(folder / name).bytes == made.bytes);
  }
}

TEST_CASE("a .bin file has the fields that the user names", "[records][bin]") {
  const TemporaryFolder folder;
  const std::string row = floats({1, 2, 3}) + bytes_of<std::uint16_t>({40000}) +
                          std::string("\x01\x02") + bytes_of<double>({0.1}) + "\xFF";
  const auto path = folder.write("a.bin", row + row);
  const RecordReading reading{"x y z ring:u2 _:u1[2] t:f8 tag:i1"};
  const PointRecords records = read_records(path, reading);
  CHECK(records.size() == 2);
  CHECK(column(records, "ring") == std::vector<double>{40000, 40000});
  CHECK(column(records, "t") == std::vector<double>{0.1, 0.1});
  CHECK(column(records, "tag") == std::vector<double>{-1, -1});
  write_records(folder / "b.bin", records);
  CHECK(read_text(folder / "b.bin") == row + row);
  const Cloud cloud = read_cloud(path, Eigen::Vector3d(1, 0, 0), reading);
  CHECK(cloud.points == std::vector<Eigen::Vector3f>{{0, 2, 3}, {0, 2, 3}});
  CHECK(cloud.intensity.empty());
}

TEST_CASE("a point layout that cannot be is named", "[records][layout]") {
  const auto says = [](const std::string& text) {
    return message_of<UsageError>([&] { parse_point_layout(text); });
  };
  check_says(says("x y"), {"'z' with one value is missing", "expected the fields"});
  check_says(says("x y z:f4[2]"), {"'z' with one value"});
  check_says(says("x y z x"), {"'x' occurs twice"});
  check_says(says("x y z t:f2"), {"'t:f2' has no known type"});
  for (const char* word : {"t:", "t:u3", "t:f8[", "t:f8[0]", "t:f8[65537]", "t:f8[1]x"}) {
    check_says(says(std::string("x y z ") + word), {"no known type"});
  }
  check_says(says("x y z :f4"), {"has no name"});
  check_says(says("x y z a:f8[65536] b:f8[65536] c:u1"), {"too large"});
  const RecordLayout layout = parse_point_layout(" x\ty z _ _:u1[3] n:f4[3] ");
  CHECK(field_texts(layout) ==
        std::vector<std::string>{"float32 x", "float32 y", "float32 z", "float32[3] n"});
  CHECK(layout.row_bytes == 12 + 4 + 3 + 12);
}

TEST_CASE("a writer refuses what cannot be before the file appears", "[records]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(PointRecordWriter(folder / "a.npz"), UsageError);
  check_says(message_of<UsageError>([&] { PointRecordWriter(folder / "a.laz"); }), {"laszip"});
  CHECK_THROWS_AS(format_losses("a.xyz", {}), UsageError);
  PointRecordWriter writer(folder / "a.pcd");
  check_says(message_of<DataError>([&] { writer.start({}); }), {"no field 'x'"});
  writer.start(parse_point_layout("x y z"));
  PointRecords other;
  other.layout = parse_point_layout("x y z t");
  CHECK_THROWS_AS(writer.add(other), InternalError);
  CHECK_FALSE(std::filesystem::exists(folder / "a.pcd"));
}
