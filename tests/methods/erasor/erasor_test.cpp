// SPDX-License-Identifier: MIT
#include "methods/erasor/erasor.h"

#include <catch2/catch.hpp>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

using Numbers = std::vector<int>;

const std::vector<float> kCar = {0.6F, 1.0F, 1.5F};

/// The road as a later scan sees it, with a height of 5 cm.
Points empty_road() {
  Points points = road();
  points[0].z() = 0.05F;
  return points;
}

}  // namespace

TEST_CASE("a car that is gone is removed", "[erasor]") {
  // Map 1.5 m high, query 0.05 m: ratio 0.033.
  CHECK(removed_by(empty_road(), road_and(kCar), small_grid()) == Numbers{4, 5, 6});
  // The order of the scans does not matter to the map: a car that comes later is removed too.
  Parameters first_asks = small_grid();
  first_asks.phase = 0;
  CHECK(removed_points(scans_of({empty_road(), road_and(kCar)}), first_asks)[1] ==
        Numbers{4, 5, 6});
}

TEST_CASE("where a wheel touches the road it stays", "[erasor]") {
  Points first = road_and(kCar);
  first.emplace_back(2.8F, 0.6F, 0.1F);
  CHECK(removed_by(empty_road(), first, small_grid()) == Numbers{4, 5, 6});
}

TEST_CASE("a bin that the query hardly sees stays", "[erasor]") {
  const Points two = {{2.5F, 0.5F, 0}, {3.5F, 1, 0}};
  CHECK(removed_by(two, road_and(kCar), small_grid()).empty());
  CHECK(removed_by({}, road_and(kCar), small_grid()).empty());
  // Points are counted after thinning: two voxels, however full.
  const Points dense = {{2.5F, 0.5F, 0}, {2.51F, 0.5F, 0}, {2.52F, 0.5F, 0}, {3.5F, 1, 0}};
  CHECK(removed_by(dense, road_and(kCar), small_grid()).empty());
  const Points three = {{2.5F, 0.5F, 0}, {3.5F, 0.5F, 0}, {3.5F, 1, 0}};
  CHECK(removed_by(three, road_and(kCar), small_grid()).size() == 3);
}

TEST_CASE("a car under a canopy stays unless the window ends below the leaves", "[erasor]") {
  const std::vector<float> car_and_leaves = {0.6F, 1.0F, 1.5F, 2.6F, 2.9F};
  const Points first = road_and(car_and_leaves);
  Points leaves_seen = road_and({2.6F, 2.9F});
  Parameters parameters = small_grid();
  CHECK(removed_by(leaves_seen, first, parameters).empty());
  parameters.maximum_height = 2.0;
  CHECK(removed_by(leaves_seen, first, parameters) == Numbers{4, 5, 6});
  // Leaves that are hidden from the query go with the car.
  parameters.maximum_height = 3.0;
  CHECK(removed_by(empty_road(), first, parameters) == Numbers{4, 5, 6, 7, 8});
}

TEST_CASE("heights are above the road below the sensor", "[erasor]") {
  // The same scene seen from 1.73 m up; with the height left at zero it is below the window.
  const auto lowered = [](Points points) {
    for (Eigen::Vector3f& point : points) point.z() -= 1.73F;
    return points;
  };
  Parameters parameters = small_grid();
  parameters.maximum_height = 1.2;
  parameters.sensor_height = 1.73;
  CHECK(removed_by(lowered(empty_road()), lowered(road_and(kCar)), parameters) == Numbers{4, 5});
}

TEST_CASE("a tilted sensor sees the same bins", "[erasor]") {
  // Only the body frame counts: on a slope of 20 degrees heights are across the slope.
  Pose slope = Pose::Identity();
  slope.translation() << 103.7, -55.1, 4.2;
  slope.linear() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(20 * kDegree, Eigen::Vector3d::UnitY()))
                       .toRotationMatrix();
  HeldScans scans;
  scans.add(road_and(kCar), slope);
  scans.add(empty_road(), slope);
  CHECK(removed_points(scans, small_grid())[0] == Numbers{4, 5, 6});
}

TEST_CASE("the own car's points answer through voxels that others filled", "[erasor]") {
  // Scan 2 is 1 m ahead: the car is 2.1 m away, within its ego radius. Its point in the voxel that
  // the first query cleared is removed; a point above it, in a voxel of no other scan, is kept.
  Pose ahead = Pose::Identity();
  ahead.translation().x() = 1.0;
  HeldScans scans;
  Points first = road_and(kCar), query = empty_road();
  for (Points* points : {&first, &query}) {
    (*points)[0].x() = (*points)[1].x() = 2.9F;  // Beyond the ego radius.
  }
  scans.add(first);
  scans.add(query);
  scans.add({{2.0F, 0.75F, 1.5F}, {2.0F, 0.75F, 2.2F}}, ahead);
  Parameters parameters = small_grid();
  parameters.minimum_range = 2.7;
  const auto removed = removed_points(scans, parameters);
  CHECK(removed[0] == Numbers{4, 5, 6});
  CHECK(removed[2] == Numbers{0});
}

TEST_CASE("an empty window is refused", "[erasor]") {
  Parameters parameters;
  parameters.minimum_height = parameters.maximum_height;
  CHECK_THROWS_WITH(make_erasor(parameters), Catch::Contains("erasor.min_h = 3"));
  parameters = {};
  parameters.maximum_range = 2.0;
  CHECK_THROWS_WITH(make_erasor(parameters), Catch::Contains("erasor.max_range = 2"));
}

}  // namespace raymoval::erasor_test
