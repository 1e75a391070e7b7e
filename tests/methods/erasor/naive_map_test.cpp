// SPDX-License-Identifier: MIT
#include "methods/erasor/naive_map.h"

#include <catch2/catch.hpp>
#include <random>

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

constexpr double kVoxel = 0.2;

VoxelKey key_of(const Eigen::Vector3d& point) {
  return voxel_key(voxel_index(point, 1 / kVoxel));
}

void add_scan(NaiveMapBuilder& builder, const std::vector<Eigen::Vector3d>& points) {
  std::vector<VoxelKey> keys;
  for (const Eigen::Vector3d& point : points) keys.push_back(key_of(point));
  builder.add(keys, points);
}

}  // namespace

TEST_CASE("a voxel that reaches over the edge of a tile comes back from either side", "[erasor]") {
  // Tiles end at 5 m, and a voxel of 0.3 m extends from 4.8 to 5.1 m along each axis.
  const auto key = voxel_key(voxel_index(Eigen::Vector3d(5.0, 5.0, 0.1), 1 / 0.3));
  for (const double place : {4.85, 5.05}) {
    NaiveMapBuilder builder;
    builder.add({key, voxel_key(3, 3, 0)}, {{place, 9.9 - place, 0.1}, {1.0, 1.0, 0.1}});
    NaiveMap map = builder.finish();
    const VoxelNumber voxel = map.point(0).x() > 2.0 ? 0 : 1;
    for (const double x : {4.81, 5.09}) {
      for (const double y : {4.81, 5.09}) {
        map.take_out(voxel);
        map.put_back(key, {x, y, 0.1});
        CHECK(map.is_in(voxel));
        CHECK_FALSE(map.is_out(key));
      }
    }
  }
}

TEST_CASE("the tiles around a pose hold every voxel within the radius, once", "[erasor]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  NaiveMapBuilder builder;
  std::vector<Eigen::Vector3d> points(5000);
  for (Eigen::Vector3d& point : points) point = {place(random), place(random), place(random) / 20};
  add_scan(builder, points);
  const NaiveMap map = builder.finish();
  for (int round = 0; round < 50; ++round) {
    const double x = place(random), y = place(random), radius = 1.0 + std::abs(place(random)) / 2;
    std::vector<int> seen(map.size(), 0);
    for (const NaiveMap::Tile& tile : map.tiles_around(x, y, radius)) {
      for (VoxelNumber v = tile.begin; v < tile.end; ++v) ++seen[v];
    }
    int twice = 0, missed = 0, far = 0;
    for (VoxelNumber v = 0; v < map.size(); ++v) {
      const double distance = std::hypot(map.point(v).x() - x, map.point(v).y() - y);
      twice += seen[v] > 1 ? 1 : 0;
      missed += distance < radius && seen[v] == 0 ? 1 : 0;
      far += distance > radius + 7.08 && seen[v] != 0 ? 1 : 0;  // A tile's diagonal is 7.07 m.
    }
    CHECK(twice == 0);
    CHECK(missed == 0);
    CHECK(far == 0);
  }
}

}  // namespace raymoval::erasor_test
