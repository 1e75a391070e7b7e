// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <limits>
#include <numeric>
#include <set>

#include "methods/common/patchwork/ground_segmentation.h"

namespace raymoval::patchwork_test {
using namespace raymoval::patchwork;

namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Ground of a bin, one value a point.
Mask ground_in_bin(const Points& points, bool is_innermost,
                   const GroundParameters& parameters = {}) {
  Mask ground(points.size(), 9);
  if (!find_bin_ground(points, {is_innermost, parameters.sensor_height}, parameters, ground)) {
    CHECK(std::accumulate(ground.begin(), ground.end(), 0) == 0);
  }
  return ground;
}

int count_between(const Mask& mask, std::size_t begin, std::size_t end) {
  return std::accumulate(mask.begin() + static_cast<std::ptrdiff_t>(begin),
                         mask.begin() + static_cast<std::ptrdiff_t>(end), 0);
}

/// Level points of a square metre that begins at (x, 0), every 0.1 m.
Points square(double x, double z) {
  Points points;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) points.emplace_back(x + 0.1 * i, 0.1 * k, z);
  }
  return points;
}

/// Upright points at x = 6: 41 across 2 m, and up from -1.7 to 1 every 0.05 m.
void add_wall(Points& points) {
  for (int i = 0; i < 41; ++i) {
    for (int k = 0; k < 55; ++k) points.emplace_back(6.0, 0.05 * i - 1.0, 0.05 * k - 1.7);
  }
}

}  // namespace

TEST_CASE("patchwork: four zones of rings and sectors") {
  // a = 2.7, b = 80: (7a + b) / 8, (3a + b) / 4, (a + b) / 2.
  const ZoneModel zones(2.7, 80.0);
  CHECK(zones.bin_of(12.362, 0.0) == 16);
  CHECK(zones.bin_of(12.363, 0.0) == 32);
  CHECK(zones.bin_of(22.024, 0.0) == 32 + 3 * 32);
  CHECK(zones.bin_of(22.026, 0.0) == 32 + 4 * 32);
  CHECK(zones.bin_of(41.349, 0.0) == 32 + 4 * 32 + 3 * 54);
  CHECK(zones.bin_of(2.69, 0.0) == ZoneModel::kNone);
  CHECK(zones.bin_of(0.0, 80.01) == ZoneModel::kNone);
  CHECK(zones.bin_of(0.0, 0.0) == ZoneModel::kNone);
  // The first zone: two rings of 4.83 m, 16 sectors.
  CHECK(zones.bin_of(2.7, 0.0) == 0);
  CHECK(zones.bin_of(5.0, 0.1) == 0);
  CHECK(zones.bin_of(5.0, -0.1) == 15);
  CHECK(zones.bin_of(0.1, 5.0) == 3);
  CHECK(zones.bin_of(-0.1, 5.0) == 4);
  CHECK(zones.bin_of(7.5, 0.1) == 0);
  CHECK(zones.bin_of(7.6, 0.1) == 16);
  // The second zone begins with bin 32 and has 32 sectors, the third 54, the last 32.
  CHECK(zones.bin_of(12.4, 0.1) == 32);
  CHECK(zones.bin_of(0.1, 12.4) == 32 + 7);
  CHECK(zones.bin_of(22.1, 0.1) == 32 + 4 * 32);
  CHECK(zones.bin_of(41.4, 0.1) == 32 + 4 * 32 + 4 * 54);
  CHECK(zones.bin_of(79.9, -0.1) == ZoneModel::kAllBins - 1);
  CHECK(zones.bin_of(80.0, 0.0) == ZoneModel::kAllBins - 32);
  CHECK(ZoneModel::first_bin(2) == 32);
  CHECK(ZoneModel::first_bin(ZoneModel::kAllRings) == ZoneModel::kAllBins);
  CHECK(ZoneModel::is_innermost_zone(31));
  CHECK_FALSE(ZoneModel::is_innermost_zone(32));
}

TEST_CASE("patchwork: ground is what lies near the plane, and all below it") {
  Points points = square(5.0, -1.7);
  points.emplace_back(5.5, 0.5, -1.7 + 0.12);  // Less than 0.125 above the plane.
  points.emplace_back(5.5, 0.5, -1.7 + 0.14);
  points.emplace_back(5.5, 0.5, -0.5);
  points.emplace_back(5.5, 0.5, -1.9);
  const Mask ground = ground_in_bin(points, true);
  CHECK(count_between(ground, 0, 100) == 100);
  CHECK(ground[100] == 1);
  CHECK(ground[101] == 0);
  CHECK(ground[102] == 0);
  CHECK(ground[103] == 1);
}

TEST_CASE("patchwork: a slope is ground, a wall's plane is not upright") {
  Points slope, steep;
  for (const Eigen::Vector3d& point : square(5.0, -1.7)) {
    slope.push_back(point + Eigen::Vector3d(0, 0, 0.176 * (point.x() - 5.0)));  // 10 degrees.
    steep.push_back(point + Eigen::Vector3d(0, 0, 1.19 * (point.x() - 5.0)));   // 50 degrees.
  }
  Mask ground(100);
  const auto fit = find_bin_ground(slope, {true, 1.723}, {}, ground);
  REQUIRE(fit);
  CHECK(count_between(ground, 0, 100) == 100);
  CHECK(fit->plane.normal.z() == Approx(std::cos(std::atan(0.176))));
  CHECK(fit->centre.z() == Approx(-1.7 + 0.176 * 0.45));
  const auto wall = find_bin_ground(steep, {false, 1.723}, {}, ground);
  REQUIRE(wall);
  CHECK(wall->plane.normal.z() < 0.707);
  // In the innermost zone it is taken out as a wall.
  CHECK_FALSE(find_bin_ground(steep, {true, 1.723}, {}, ground));
}

TEST_CASE("patchwork: in the innermost zone a wall is taken out before ground is looked for") {
  // Of the seeds below -1.45, 205 are the wall's and four the ground's on either side: they vary
  // least along x (4 / 209 of 0.125 against 0.005 along z), so that the plane is the wall's. It is
  // taken out, and the four are left.
  Points points = {{5.6, -0.3, -1.7}, {5.7, 0.2, -1.7}, {6.3, 0.2, -1.7}, {6.4, -0.3, -1.7}};
  add_wall(points);
  const Mask inner = ground_in_bin(points, true);
  CHECK(count_between(inner, 0, 4) == 4);
  CHECK(count_between(inner, 4, points.size()) == 0);
  // Elsewhere nothing is taken out.
  Mask ground(points.size());
  const auto outer = find_bin_ground(points, {false, 1.723}, {}, ground);
  REQUIRE(outer);
  CHECK(outer->plane.normal.z() < 0.707);
  SECTION("a bin of nothing but wall has no ground") {
    Points wall;
    add_wall(wall);
    CHECK(count_between(ground_in_bin(wall, true), 0, wall.size()) == 0);
  }
}

TEST_CASE("patchwork: what lies deep in the innermost zone does not say where ground begins") {
  // Six points at -2.2, more than 1.2 sensor heights down: with them the lowest 20 have the mean
  // -1.85, so that they alone are seeds and ground; without them the mean is that of the ground.
  Points points = square(5.0, -1.7);
  for (int i = 0; i < 6; ++i) points.emplace_back(5.35 + 0.1 * (i % 3), 0.4 + 0.1 * (i / 3), -2.2);
  CHECK(count_between(ground_in_bin(points, true), 0, 100) == 100);
  CHECK(count_between(ground_in_bin(points, false), 0, 100) == 0);
  // A higher sensor has its ground deeper.
  GroundParameters high;
  high.sensor_height = 2.0;
  CHECK(count_between(ground_in_bin(points, true, high), 0, 100) == 0);
  // Descending ground is no mirror image: if all of it is deep, all of it is used.
  const Points valley = square(5.0, -3.0);
  CHECK(count_between(ground_in_bin(valley, true), 0, 100) == 100);
}

}  // namespace raymoval::patchwork_test
