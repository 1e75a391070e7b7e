// SPDX-License-Identifier: MIT
// Written LAS files: the places of values, and values that cannot be written.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/las/las_head.h"
#include "tests/datasets/clouds/record_files.h"

using namespace raymoval;
using namespace raymoval::test;

TEST_CASE("any layout goes through .las, coordinates to the millimetre", "[las]") {
  const TemporaryFolder folder;
  std::mt19937 random(11);
  for (int i = 0; i < 30; ++i) {
    const PointRecords made = random_records(random);
    write_records(folder / "a.las", made);
    const PointRecords las = read_records(folder / "a.las");
    REQUIRE(las.size() == made.size());
    // Multiples of a quarter are multiples of a millimetre, except for rounding of float64.
    for (const char* axis : {"x", "y", "z"}) {
      for (std::size_t point = 0; point < made.size(); ++point) {
        CHECK(std::abs(column(las, axis)[point] - column(made, axis)[point]) < 1e-9);
      }
    }
    for (const PointField& field : made.layout.fields) {
      if (field.name.size() == 1 && field.name != "t") continue;
      INFO(field.text());
      const bool bytes = field.type == 'U' && field.size == 1;
      const bool slot = field.name == "intensity" && field.count == 1 && field.type == 'U';
      if (slot && field.size <= 2) {
        CHECK(column(las, "intensity") == column(made, "intensity"));
      } else if (field.count == 1 || bytes) {
        CHECK(same_bytes(las, made, field.name == "intensity" ? "intensity_1" : field.name,
                         field.name));
      } else {
        CHECK(las.layout.find({field.name + "_0"}) != nullptr);
      }
    }
  }
}

TEST_CASE("LAS that is written says counts, bounds and offsets", "[las]") {
  const TemporaryFolder folder;
  PointRecords made;
  made.layout = parse_point_layout("x:f8 y:f8 z:f8 return_number:u1 intensity");
  const auto add = [&](double x, double y, double z, std::uint8_t number, float intensity) {
    for (const double value : {x, y, z}) {
      const auto* raw = reinterpret_cast<const std::byte*>(&value);
      made.bytes.insert(made.bytes.end(), raw, raw + sizeof value);
    }
    made.bytes.push_back(static_cast<std::byte>(number));
    const auto* raw = reinterpret_cast<const std::byte*>(&intensity);
    made.bytes.insert(made.bytes.end(), raw, raw + sizeof intensity);
    made.width = made.size();
  };
  add(691000.25, 5336000.5, -3, 1, 50.4F);
  add(691001.25, 5336001.5, 4, 2, 24.75F);
  add(691000.5, 5336000.75, 0, 2, 2e5F);
  write_records(folder / "a.las", made);
  const std::string bytes = read_text(folder / "a.las");
  const auto number = [&](std::size_t at, auto zero) {
    std::memcpy(&zero, bytes.data() + at, sizeof zero);
    return zero;
  };
  CHECK(number(6, std::uint16_t{}) == 16);  // WKT.
  CHECK(number(104, std::uint8_t{}) == 6);
  CHECK(number(107, std::uint32_t{}) == 0);  // Counts of the old formats.
  CHECK(number(247, std::uint64_t{}) == 3);
  CHECK(number(255, std::uint64_t{}) == 1);
  CHECK(number(263, std::uint64_t{}) == 2);
  CHECK(number(131, 0.0) == 0.001);
  CHECK(number(155, 0.0) == 0);  // Near enough to 0.
  CHECK(number(163, 0.0) == 5336000);
  CHECK(std::abs(number(179, 0.0) - 691001.25) < 1e-6);
  CHECK(std::abs(number(187, 0.0) - 691000.25) < 1e-6);
  CHECK(std::abs(number(211, 0.0) - 4) < 1e-9);
  CHECK(std::abs(number(219, 0.0) + 3) < 1e-9);
  const PointRecords las = read_records(folder / "a.las");
  CHECK(column(las, "intensity") == std::vector<double>{50, 25, 65535});
  CHECK(column(las, "intensity_1") == std::vector<double>{50.4F, 24.75, 2e5});
  CHECK(column(las, "y") == column(made, "y"));
  // What is written of a LAS file keeps its scale.
  write_records(folder / "b.las", las);
  CHECK(read_records(folder / "b.las").bytes == las.bytes);
}

TEST_CASE("what LAS cannot hold is an error before the file appears", "[las]") {
  const TemporaryFolder folder;
  PointRecords made;
  made.layout = parse_point_layout("x:f8 y:f8 z:f8 return_number:u1");
  made.bytes.resize(2 * made.layout.row_bytes);
  const auto says = [&] {
    const std::string message =
        message_of<DataError>([&] { write_records(folder / "a.las", made); });
    CHECK_FALSE(std::filesystem::exists(folder / "a.las"));
    return message;
  };
  made.set_value(1, made.layout.fields[0], 3e6);
  check_says(says(), {"point 1 has x = 3e+06", "2147483.647 m", "Nothing was changed"});
  made.set_value(1, made.layout.fields[0], std::nan(""));
  check_says(says(), {"x = nan", "not finite"});
  made.set_value(1, made.layout.fields[0], 0);
  made.set_value(1, made.layout.fields[3], 16);
  check_says(says(), {"point 1 has return_number 16", "4 bits"});
}
