// SPDX-License-Identifier: MIT
#include "methods/freedom/depth_image.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/methods/toy_world.h"

namespace raymoval::freedom_test {
using namespace raymoval::freedom_method;

namespace {

constexpr double kFarthest = 80.0;

/// '#' is a return, '.' none.
HoleImage drawn(const std::vector<std::string>& rows) {
  HoleImage image{static_cast<int>(rows.size()), static_cast<int>(rows[0].size()), {}, {}};
  for (const std::string& row : rows) {
    for (const char c : row) {
      image.values.push_back(100);
      image.is_hole.push_back(c == '.' ? 1 : 0);
    }
  }
  return image;
}

/// 'o' is a hole that is open, others as they were.
std::vector<std::string> opened(const std::vector<std::string>& rows, bool is_full_turn) {
  const std::vector<std::uint8_t> open = open_holes(drawn(rows), is_full_turn);
  std::vector<std::string> result = rows;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] != 0) result[i / rows[0].size()][i % rows[0].size()] = 'o';
  }
  return result;
}

/// Four rows from +3 to 0 degrees in steps of a degree, all around.
SensorModel four_rows() {
  SensorModel sensor;
  sensor.elevation_min = 0.0;
  sensor.elevation_max = 3.0 * kDegree;
  sensor.elevation_step = kDegree;
  sensor.range_max = 100.0;
  return sensor;
}

Eigen::Vector3f point_at(double azimuth, double elevation, double range) {
  return (range * toy::direction(azimuth * kDegree, elevation * kDegree)).cast<float>();
}

}  // namespace

TEST_CASE("freedom: only holes that are open to the top and not to the bottom are used") {
  CHECK(opened({"#..#.#..",  //
                "#.##.##.",  //
                "##.#.###",  //
                "##.#.#.#"},
               false) == std::vector<std::string>{"#oo#.#oo",  //
                                                  "#o##.##o",  //
                                                  "##.#.###",  // Corners join nothing.
                                                  "##.#.#.#"});
}

TEST_CASE("freedom: holes go on behind a full turn") {
  // The hole on the right reaches the last row on the left.
  const std::vector<std::string> image = {"##.",  //
                                          ".#.",  //
                                          ".##"};
  CHECK(opened(image, true) == image);
  CHECK(opened(image, false) == std::vector<std::string>{"##o", ".#o", ".##"});
}

TEST_CASE("freedom: the view is the sensor's") {
  DepthView view = view_for(sensor_model_named("hdl64e"), kFarthest);
  CHECK(view.rows == 64);
  CHECK(view.columns == 844);  // 360 degrees by 26.9 / 63.
  CHECK(view.is_full_turn);
  CHECK(view.unit == Approx(80.0 / 255.0));
  SensorModel narrow = four_rows();
  narrow.azimuth_min = -40.0 * kDegree;
  narrow.azimuth_max = 40.0 * kDegree;
  narrow.range_max = 51.0;
  view = view_for(narrow, kFarthest);
  CHECK(view.columns == 80);
  CHECK_FALSE(view.is_full_turn);
  CHECK(view.unit == Approx(0.2));
  CHECK(view.pixel_of(point_at(-39.5, 3.0, 5.0)) == 0);
  CHECK(view.pixel_of(point_at(39.5, 0.0, 5.0)) == 319);
  CHECK(view.pixel_of(point_at(41.0, 0.0, 5.0)) == -1);
  CHECK(view.pixel_of(point_at(0.5, 3.6, 5.0)) == -1);
  CHECK(view.pixel_of(point_at(0.5, -0.6, 5.0)) == -1);
  SECTION("of a sensor of unknown steps it has the given rows") {
    narrow.elevation_step = 0.0;
    CHECK(view_for(narrow, kFarthest).rows == 64);
  }
  SECTION("a sensor whose model makes no sense gives an image of bounded size") {
    narrow.elevation_max = narrow.elevation_min;
    narrow.elevation_step = 1e-9;
    const DepthView flat = view_for(narrow, kFarthest);
    CHECK(flat.rows == 2);
    CHECK(flat.columns <= 7200);
  }
}

TEST_CASE("freedom: each pixel's middle lies in it") {
  const DepthView view = view_for(four_rows(), kFarthest);
  for (int row = 0; row < view.rows; ++row) {
    for (int column = 0; column < view.columns; ++column) {
      const Eigen::Vector3f middle = (7.0 * view.direction(row, column)).cast<float>();
      REQUIRE(view.pixel_of(middle) == row * view.columns + column);
    }
  }
}

TEST_CASE("freedom: a sensor of sparse directions has a column for each of them") {
  for (const bool is_full : {true, false}) {
    // Directions 3 degrees apart, and beams one: -180 to 177 degrees, or -45 to 45.
    const int directions = is_full ? 120 : 31;
    const double first = is_full ? -180.0 : -45.0;
    SensorModel sensor = four_rows();
    sensor.azimuth_step = 3.0 * kDegree;
    if (!is_full) {
      sensor.azimuth_min = -45.0 * kDegree;
      sensor.azimuth_max = 45.0 * kDegree;
    }
    const DepthView view = view_for(sensor, kFarthest);
    CAPTURE(is_full);
    CHECK(view.is_full_turn == is_full);
    CHECK(view.columns == directions);
    CHECK(view.rows == 4);
    // A wall of 20 m in the lower three rows, and above it in all but the first and last five
    // directions. Each return is a little beside its direction, to either side in turn.
    Scan scan;
    for (int k = 0; k < directions; ++k) {
      const bool is_low = k < 5 || k >= directions - 5;
      for (int row = is_low ? 1 : 0; row < 4; ++row) {
        const double beside = (k + row) % 2 == 0 ? 0.02 : -0.02;
        scan.points.push_back(point_at(first + 3.0 * k + beside, 3.0 - row, 20.0));
      }
    }
    const HoleImage image = depth_image(scan, view);
    CHECK(std::count(image.is_hole.begin(), image.is_hole.end(), 1) == 10);
    const std::vector<Eigen::Vector3d> ends = find_hole_ends(scan, view);
    REQUIRE(ends.size() == 10);
    for (int i = 0; i < 10; ++i) {
      const double azimuth = first + 3.0 * (i < 5 ? i : directions - 10 + i);
      const Eigen::Vector3d expected = point_at(azimuth, 3.0, 1.0).cast<double>();
      CHECK(ends[static_cast<std::size_t>(i)].normalized().isApprox(expected, 1e-6));
    }
  }
}

TEST_CASE("freedom: the nearest return of a pixel counts, from the least range on") {
  const DepthView view = view_for(four_rows(), kFarthest);
  Scan scan;
  for (const double range : {30.0, 20.0, 40.0, 0.1, 81.0}) {
    scan.points.push_back(point_at(0.5, 1.0, range));
  }
  scan.points.push_back({0.0F, 0.0F, 0.0F});
  const HoleImage image = depth_image(scan, view);
  const std::size_t pixel = static_cast<std::size_t>(view.pixel_of(scan.points[0]));
  CHECK(image.is_hole[pixel] == 0);
  CHECK(image.values[pixel] == 63);  // 20 m of 80 / 255 m, rounded down.
  CHECK(std::count(image.is_hole.begin(), image.is_hole.end(), 0) == 1);
}

TEST_CASE("freedom: rays go into the sky above a wall as far as the wall is away") {
  // A wall of 20 m all around in the lower three rows, and above it in all but ten columns, five of
  // which are on either side of the back.
  Scan scan;
  for (int column = 0; column < 360; ++column) {
    const double azimuth = column + 0.5 - 180.0;
    for (int row = column < 5 || column >= 355 ? 1 : 0; row < 4; ++row) {
      scan.points.push_back(point_at(azimuth, 3.0 - row, 20.0));
    }
  }
  const DepthView view = view_for(four_rows(), kFarthest);
  const std::vector<Eigen::Vector3d> ends = find_hole_ends(scan, view);
  REQUIRE(ends.size() == 10);
  for (const Eigen::Vector3d& end : ends) {
    CHECK(std::asin(end.z() / end.norm()) == Approx(3.0 * kDegree));
    // 63 units but one for the margin of 0.2 m. Gradients and rounding up add up to two.
    CHECK(std::abs(end.norm() / view.unit - 62) < 2.1);
  }
  CHECK(find_hole_ends(Scan{}, view).empty());  // A hole down to the last row.
}

}  // namespace raymoval::freedom_test
