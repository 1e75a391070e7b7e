// SPDX-License-Identifier: MIT
#include "methods/octomap/occupancy_map.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <random>

#include "tests/methods/octomap/hand_scans.h"

namespace raymoval::octomap_test {
using namespace raymoval::octomap_method;

namespace {

/// A room with a moving box in it, seen from a moving place, without anything exact about it.
Points random_scan(std::mt19937& random, const Eigen::Vector3d& origin, double mover) {
  std::normal_distribution<double> direction;
  Points points;
  for (int i = 0; i < 900; ++i) {
    const Eigen::Vector3d u =
        Eigen::Vector3d(direction(random), direction(random), 0.3 * direction(random)).normalized();
    const Box box{{mover, 1.03, -3}, {mover + 1.1, 1.9, 3}};
    double distance = enter_distance(box, origin, u);
    for (int k = 0; k < 3; ++k) {
      const double wall = k == 2 ? 1.57 : 4.93;
      if (u[k] != 0.0)
        distance = std::min(distance, (std::copysign(wall, u[k]) - origin[k]) / u[k]);
    }
    points.push_back(origin + distance * u);
  }
  return points;
}

void insert(OccupancyMap& map, const Points& points, const Eigen::Vector3d& origin,
            const RunContext& context = {}) {
  map.insert(rounded(points), std::vector<PointRole>(points.size(), PointRole::kSurface),
             rounded(origin), context);
}

/// Inserts scans into a map that is kept to the cells of all points, and by `insertPointCloud`.
void compare_with_library(const Parameters& parameters, int threads) {
  constexpr int kScans = 12;
  std::mt19937 random(11);
  std::vector<Points> scans;
  std::vector<Eigen::Vector3d> origins;
  OccupancyMap map(parameters);
  std::vector<octomap::OcTreeKey> cells;
  for (int scan = 0; scan < kScans; ++scan) {
    origins.emplace_back(0.013 + 0.2 * (scan % 4), -0.51, 0.017);
    scans.push_back(random_scan(random, origins.back(), -2.0 + 0.21 * scan));
    for (const octomap::point3d& point : rounded(scans.back())) {
      cells.push_back(*map.cell_of(point));
      map.keep(cells.back());
    }
  }
  octomap::OcTree plain(parameters.resolution);
  for (std::size_t scan = 0; scan < scans.size(); ++scan) {
    octomap::Pointcloud cloud;
    for (const octomap::point3d& point : rounded(scans[scan])) cloud.push_back(point);
    plain.insertPointCloud(cloud, rounded(origins[scan]), parameters.maximum_range);
    insert(map, scans[scan], origins[scan], {.threads = threads});
    const auto is_different = [&](const octomap::OcTreeKey& cell) {
      const octomap::OcTreeNode *expected = plain.search(cell), *found = map.tree().search(cell);
      if (expected == nullptr || found == nullptr) return expected != found;
      return found->getLogOdds() != expected->getLogOdds();
    };
    INFO("scan " << scan);
    REQUIRE(std::count_if(cells.begin(), cells.end(), is_different) == 0);
  }
  CHECK(map.tree().getNumLeafNodes() <= cells.size());
  CHECK(map.tree().search(rounded(origins[0])) == nullptr);  // Crossed, but not kept.
}

}  // namespace

TEST_CASE("kept cells have the log-odds that insertPointCloud gives") {
  Parameters parameters;
  SECTION("0.2 m") {}
  SECTION("0.1 m") {
    parameters.resolution = 0.1;
  }
  SECTION("beams cut") {
    parameters.maximum_range = 3.1;
  }
  for (const int threads : {1, 3}) compare_with_library(parameters, threads);
}

TEST_CASE("cells are half open and negative ones are found by floor") {
  const Parameters parameters;
  const OccupancyMap map(parameters);
  const auto key_of = [&](float x) { return (*map.cell_of({x, 0.1F, 0.1F}))[0] - 32768; };
  CHECK(key_of(0.1F) == 0);
  CHECK(key_of(-0.1F) == -1);
  CHECK(key_of(-0.3F) == -2);
  // 1.4 is 1.39999998 in float: the sixth cell, not the seventh.
  CHECK(key_of(1.4F) == 6);
  CHECK_FALSE(map.cell_of({6553.7F, 0, 0}).has_value());
  CHECK_FALSE(map.cell_of({0, -6553.7F, 0}).has_value());
  CHECK_FALSE(map.cell_of({0, 1e30F, 0}).has_value());
  CHECK(map.cell_of({6553.5F, -6553.5F, 0}).has_value());
  CHECK_FALSE(map.cell_of({std::numeric_limits<float>::quiet_NaN(), 0, 0}).has_value());
}

TEST_CASE("a beam too short to be squared ends, wherever its sensor stands") {
  // The sensor of the first scan is in the tree's centre, on cell walls along all axes.
  HandMap map({});
  for (const double length : {1e-45, 1e-38, 1e-27, 1e-20, 1e-15, 1e-9}) {
    for (int signs = 0; signs < 27; ++signs) {
      const Eigen::Vector3d beam(signs % 3 - 1, signs / 3 % 3 - 1, signs / 9 - 1);
      for (const double height : {0.0, 1.0}) {
        const Eigen::Vector3d origin(0, 0, height);
        map.insert({origin + length * beam}, origin);
      }
    }
  }
  CHECK(map.log_odds({-0.1, -0.1, -0.1}) > 0.0);  // The hits count.
}

TEST_CASE("a beam through more cells than a KeyRay holds is a hit and frees nothing") {
  Parameters parameters;
  parameters.resolution = 0.01;
  const Eigen::Vector3d far(327.0, 327.0, 327.0);
  OccupancyMap map(parameters);
  map.keep(*map.cell_of(rounded(far)));
  map.keep(*map.cell_of({0, 0, 0}));
  insert(map, {far}, -far);
  CHECK(map.tree().search(rounded(far)) != nullptr);
  CHECK(map.tree().search(0.0, 0.0, 0.0) == nullptr);
}

TEST_CASE("a run that is cancelled ends within a scan") {
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  const Parameters parameters;
  OccupancyMap map(parameters);
  CHECK_THROWS_AS(insert(map, {{3.0, 0.0, 0.0}}, {0.0, 0.0, 0.0}, context), Cancelled);
}

}  // namespace raymoval::octomap_test
