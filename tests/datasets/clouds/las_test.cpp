// SPDX-License-Identifier: MIT
// LAS files made by hand, byte by byte, after the LAS 1.4 specification (R15).
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/las/las_fields.h"
#include "datasets/clouds/las/las_head.h"
#include "tests/datasets/clouds/record_files.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

struct LasMaker {
  int minor = 4, format = 6;
  std::size_t record_bytes = las_record_bytes(6);
  std::string records = {};  ///< Of variable length.
  std::uint32_t record_count = 0;
  std::string points = {};
  std::string behind = {};

  void add_record(const std::string& user, int id, const std::string& content) {
    std::string head(54, '\0');
    head.replace(2, user.size(), user);
    put(head, 18, static_cast<std::uint16_t>(id));
    put(head, 20, static_cast<std::uint16_t>(content.size()));
    records += head + content;
    ++record_count;
  }
  [[nodiscard]] std::string file() const {
    const std::size_t size = minor == 4 ? 375 : minor == 3 ? 235 : 227;
    std::string head(size, '\0');
    head.replace(0, 4, "LASF");
    head[24] = 1;
    head[25] = static_cast<char>(minor);
    put(head, 94, static_cast<std::uint16_t>(size));
    put(head, 96, static_cast<std::uint32_t>(size + records.size()));
    put(head, 100, record_count);
    head[104] = static_cast<char>(format);
    put(head, 105, static_cast<std::uint16_t>(record_bytes));
    const std::uint64_t count = points.size() / record_bytes;
    if (format < 6) put(head, 107, static_cast<std::uint32_t>(count));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(head, 131 + 8 * axis, 0.01);
      put(head, 155 + 8 * axis, 100.0 * static_cast<double>(axis));
    }
    if (minor == 4) put(head, 247, count);
    return head + records + points + behind;
  }
};

/// A point of X, Y, Z and zeros.
std::string las_point(std::size_t bytes, std::int32_t x, std::int32_t y, std::int32_t z) {
  std::string point(bytes, '\0');
  put(point, 0, x);
  put(point, 4, y);
  put(point, 8, z);
  return point;
}

std::string extra_field(int type, const std::string& name, int options = 0) {
  std::string text(192, '\0');
  text[2] = static_cast<char>(type);
  text[3] = static_cast<char>(options);
  return text.replace(4, name.size(), name);
}

std::string las_error(const std::string& content) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.las", content);
  const std::string message = message_of<DataError>([&] { read_records(path); });
  CHECK(message_of<DataError>([&] { read_cloud(path); }) == message);
  return message;
}

}  // namespace

TEST_CASE("points of the old formats have their bits and bytes where LAS has them", "[las]") {
  const TemporaryFolder folder;
  LasMaker las;
  las.minor = 2;
  las.format = 3;
  las.record_bytes = 34;
  las.points = las_point(34, -100, 5, 7);
  put<std::uint16_t>(las.points, 12, 60000);
  las.points[14] = static_cast<char>(0b10'011'010);  // Edge; 3 returns; the second.
  las.points[15] = static_cast<char>(0b101'11111);   // Withheld, synthetic; class 31.
  las.points[16] = static_cast<char>(-90);
  las.points[17] = static_cast<char>(200);
  put<std::uint16_t>(las.points, 18, 1234);
  put(las.points, 20, 1e9 + 0.1);
  for (std::uint16_t i = 0; i < 3; ++i) {
    put(las.points, 28 + 2 * i, static_cast<std::uint16_t>(1000 + i));
  }
  const auto path = folder.write("a.las", las.file());
  const PointRecords records = read_records(path);
  REQUIRE(records.size() == 1);
  const auto is = [&](const char* name, double value) {
    INFO(name);
    CHECK(column(records, name) == std::vector<double>{value});
  };
  is("x", -1.0);
  is("y", 100.05);
  is("z", 7 * 0.01 + 200);
  is("intensity", 60000);
  is("return_number", 2);
  is("number_of_returns", 3);
  is("scan_direction_flag", 0);
  is("edge_of_flight_line", 1);
  is("classification", 31);
  is("synthetic", 1);
  is("key_point", 0);
  is("withheld", 1);
  is("scan_angle_rank", -90);
  is("user_data", 200);
  is("point_source_id", 1234);
  is("gps_time", 1e9 + 0.1);
  is("red", 1000);
  is("green", 1001);
  is("blue", 1002);
  CHECK(records.las->scale == Eigen::Vector3d(0.01, 0.01, 0.01));
  const Cloud cloud = read_cloud(path, Eigen::Vector3d(0, 100, 0));
  CHECK((cloud.points.at(0) - Eigen::Vector3f(-1, 0.05F, 200.07F)).norm() < 1e-4F);
  CHECK(cloud.intensity == std::vector<float>{60000});

  // Written again it is LAS 1.4, with all of these.
  write_records(folder / "b.las", records);
  const PointRecords again = read_records(folder / "b.las");
  for (const PointField& field : records.layout.fields) {
    const bool extra = field.name == "scan_angle_rank";
    INFO(field.name);
    CHECK(same_bytes(again, records, extra ? "scan_angle_rank_1" : field.name, field.name));
  }
  CHECK(column(again, "scan_angle") == std::vector<double>{-15000});
}

TEST_CASE("points of every format read with their bytes", "[las]") {
  const TemporaryFolder folder;
  constexpr std::size_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  for (int format = 0; format < kLasFormats; ++format) {
    LasMaker las;
    las.format = format;
    las.record_bytes = las_record_bytes(format);
    CHECK(las.record_bytes == kBytes[format]);
    las.points = las_point(las.record_bytes, 1, 2, 3) + las_point(las.record_bytes, 4, 5, 6);
    las.points.back() = '\x40';
    const PointRecords records = read_records(folder.write("a.las", las.file()));
    CHECK(column(records, "x").back() == 4 * 0.01);
    if (format == 4 || format == 5 || format >= 9) CHECK(column(records, "z_t").back() == 2.0);
    if (format == 8) CHECK(column(records, "nir").back() == 0x4000);
  }
}

TEST_CASE("flags of the new formats stand in bits of their own", "[las]") {
  const TemporaryFolder folder;
  LasMaker las;
  las.points = las_point(30, 0, 0, 0);
  las.points[14] = static_cast<char>(0xF1);  // The first of 15 returns.
  las.points[15] = static_cast<char>(0b0110'1010);
  las.points[16] = static_cast<char>(251);
  put<std::int16_t>(las.points, 18, -30000);
  const PointRecords records = read_records(folder.write("a.las", las.file()));
  const std::vector<std::pair<const char*, double>> values = {{"return_number", 1},
                                                              {"number_of_returns", 15},
                                                              {"synthetic", 0},
                                                              {"key_point", 1},
                                                              {"withheld", 0},
                                                              {"overlap", 1},
                                                              {"scanner_channel", 2},
                                                              {"scan_direction_flag", 1},
                                                              {"edge_of_flight_line", 0},
                                                              {"classification", 251},
                                                              {"scan_angle", -30000}};
  for (const auto& [name, value] : values) {
    INFO(name);
    CHECK(column(records, name) == std::vector<double>{value});
  }
}

TEST_CASE("extra bytes are fields as they are described, and the rest one more", "[las]") {
  const TemporaryFolder folder;
  LasMaker las;
  std::string described = extra_field(9, "Amplitude") + extra_field(0, "zero", 0) +
                          extra_field(0, "raw", 3) + extra_field(14, "two") +
                          extra_field(8, "intensity") + extra_field(1, "") + extra_field(1, "");
  // A scale: bit 3 of the options, and the number at 112.
  described[3] = 8 | 2;
  put(described, 112, 0.5);
  las.add_record("LASF_Spec", 4, described);
  las.record_bytes = 30 + 4 + 3 + 4 + 8 + 1 + 1 + 2;
  las.points = las_point(30, 1, 2, 3) + floats({2.5F}) + "abc" + bytes_of<std::int16_t>({-3, 4}) +
               bytes_of<std::int64_t>({-1LL << 62}) + "de" + "fg";
  const PointRecords records = read_records(folder.write("a.las", las.file()));
  const auto texts = field_texts(records.layout);
  CHECK(std::vector<std::string>(texts.end() - 7, texts.end()) ==
        std::vector<std::string>{"float32 Amplitude", "uint8[3] raw", "int16[2] two",
                                 "int64 intensity_1", "uint8 extra_bytes", "uint8 extra_bytes_1",
                                 "uint8[2] undescribed_bytes"});
  CHECK(column(records, "two") == std::vector<double>{-3, 4});
  CHECK(column(records, "raw") == std::vector<double>{'a', 'b', 'c'});
  CHECK(column(records, "undescribed_bytes") == std::vector<double>{'f', 'g'});

  write_records(folder / "b.las", records);
  const PointRecords again = read_records(folder / "b.las");
  for (const char* name : {"Amplitude", "raw", "intensity_1", "extra_bytes", "undescribed_bytes"}) {
    INFO(name);
    CHECK(same_bytes(again, records, name, name));
  }
  CHECK(column(again, "two_0") == std::vector<double>{-3});
  CHECK(column(again, "two_1") == std::vector<double>{4});
  // The scale is kept; that there are bounds is not.
  const std::string description = again.las->extra_bytes.at("Amplitude");
  CHECK(description[3] == 8);
  CHECK(description.substr(112, 8) == bytes_of<double>({0.5}));
}

TEST_CASE("many extra bytes of one name are told apart quickly", "[las]") {
  const TemporaryFolder folder;
  LasMaker las;
  std::string described;
  for (int i = 0; i < 341; ++i) described += extra_field(1, "intensity");
  las.add_record("LASF_Spec", 4, described);
  las.record_bytes = 30 + 341;
  las.points = las_point(las.record_bytes, 1, 2, 3);
  const PointRecords records = read_records(folder.write("a.las", las.file()));
  CHECK(records.layout.fields.back().name == "intensity_341");
  write_records(folder / "b.las", records);
  CHECK(read_records(folder / "b.las").layout == records.layout);
  PointRecords more = records;
  more.layout.add("one", 'U', 1);
  more.bytes.emplace_back();
  check_says(message_of<DataError>([&] { write_records(folder / "c.las", more); }),
             {"342 values", "at most 341"});
}

TEST_CASE("heads of LAS that cannot be are named", "[las]") {
  LasMaker las;
  las.points = las_point(30, 1, 2, 3) + las_point(30, 4, 5, 6);
  const std::string good = las.file();
  const auto with = [&](std::size_t at, auto number) {
    std::string bytes = good;
    put(bytes, at, number);
    return las_error(bytes);
  };
  check_says(las_error("LASS"), {"not a LAS file"});
  check_says(las_error(good.substr(0, 300)), {"ends within its head, after 300 bytes"});
  check_says(las_error(good.substr(0, good.size() - 1)),
             {"announces 2 points of 30 bytes", "only 59 bytes follow", "after point 1"});
  check_says(with(25, std::uint8_t{5}), {"LAS 1.5"});
  check_says(with(104, std::uint8_t{11}), {"point format 11"});
  check_says(with(104, std::uint8_t{0x86}), {"LAZ", "laszip -i"});
  check_says(with(105, std::uint16_t{29}), {"29 bytes", "format 6 takes 30"});
  check_says(with(247, std::uint64_t{1}), {"announces 1 points", "bytes for 2"});
  check_says(with(247, std::uint64_t{0}), {"announces 0 points"});
  check_says(with(247, ~std::uint64_t{0}), {"truncated after point 2"});
  check_says(with(131, 0.0), {"scales"});
  check_says(with(139, std::nan("")), {"scales"});
  check_says(with(155, HUGE_VAL), {"offsets"});
  check_says(with(100, std::uint32_t{4000000000U}), {"ends within its head"});
  check_says(with(96, std::uint32_t{4000000000U}), {"points begin beyond its end"});
  LasMaker laz = las;
  laz.add_record("laszip encoded", 22204, "x");
  check_says(las_error(laz.file()), {"LAZ"});
  LasMaker extra = las;
  extra.add_record("LASF_Spec", 4, extra_field(10, "a"));
  check_says(las_error(extra.file()), {"takes at least 8 bytes a point, but there are 0"});
  LasMaker unknown = las;
  unknown.add_record("LASF_Spec", 4, extra_field(31, "a"));
  check_says(las_error(unknown.file()), {"'a' have the unknown type 31"});
}

TEST_CASE("cuts and flipped bytes of a LAS file give points or a DataError", "[las]") {
  LasMaker las;
  las.add_record("LASF_Spec", 4, extra_field(9, "a") + extra_field(0, "b", 2));
  las.record_bytes = 36;
  las.points = las_point(36, 1, 2, 3) + las_point(36, 4, 5, 6);
  const std::string good = las.file();
  read_cut_and_flipped("a.las", good, 3, [&](const std::filesystem::path& path) {
    const std::size_t points = read_records(path).size();
    CHECK(points <= good.size());
  });
}
