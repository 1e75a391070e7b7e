// SPDX-License-Identifier: MIT
#include "methods/raymoval/validation.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/common/sparse_blocks.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

namespace {

ScanPoints points_at(const std::vector<Eigen::Vector3d>& positions, double range) {
  ScanPoints points;
  for (const Eigen::Vector3d& position : positions) {
    points.position.push_back(position);
    points.voxel.push_back(voxel_index(position, 5.0));
    points.range.push_back(range);
  }
  return points;
}

std::vector<int> all_of(const ScanPoints& points) {
  std::vector<int> members(points.size());
  for (std::size_t i = 0; i < members.size(); ++i) members[i] = static_cast<int>(i);
  return members;
}

/// Settings under which only the rule that a test is about can reject.
Parameters lenient() {
  Parameters parameters;
  parameters.cluster_points = 0;
  parameters.cluster_width = 0;
  parameters.coverage_static = 1.01;
  parameters.coverage_edge = 1.01;
  parameters.support_share = 1;
  parameters.minimum_points = 0;
  parameters.minimum_width = 0;
  return parameters;
}

}  // namespace

TEST_CASE("eq. 12: the width is the diagonal of the box from above") {
  Extent extent;
  extent.add({0, 0, 0});
  extent.add({3, 4, 9});
  CHECK(extent.width() == Approx(5.0));
}

TEST_CASE("eq. 13: clusters need points and width, fewer points farther away") {
  Parameters parameters = lenient();
  parameters.cluster_points = 12;
  parameters.cluster_width = 0.2;
  // m(10) = 12, m(20) = 12 / 4 = 3; never below 3.
  CHECK(cluster_points_at(10, parameters) == Approx(12));
  CHECK(cluster_points_at(20, parameters) == Approx(3));
  CHECK(cluster_points_at(60, parameters) == Approx(3));
  const ScanPoints near = points_at({{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}}, 10);
  const ScanPoints far = points_at({{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}}, 20);
  const ScanPoints narrow = points_at({{0, 0, 0}, {0.1, 0, 0}, {0, 0, 1}}, 20);
  CHECK_FALSE(passes_cluster_screen({0, 1, 2}, near, parameters));
  CHECK(passes_cluster_screen({0, 1, 2}, far, parameters));
  CHECK_FALSE(passes_cluster_screen({0, 1, 2}, narrow, parameters));
}

TEST_CASE("eq. 14: coverage is the share of points in the dilated map") {
  OccupancyMap map(0.2);
  map.insert({0, 0, 0});
  // Cells 0, 1, 2, 3 along x.
  const ScanPoints points =
      points_at({{0.1, 0.1, 0.1}, {0.3, 0.1, 0.1}, {0.5, 0.1, 0.1}, {0.7, 0.1, 0.1}}, 10);
  CHECK(coverage(all_of(points), points, map, 0) == Approx(0.25));
  CHECK(coverage(all_of(points), points, map, 1) == Approx(0.5));
  CHECK(coverage(all_of(points), points, map, 2) == Approx(0.75));
}

TEST_CASE("eq. 15: covered groups are static, thin ones with less coverage") {
  Parameters parameters;
  parameters.coverage_static = 0.9;
  parameters.coverage_edge = 0.5;
  parameters.thin_side = 0.4;
  CHECK(belongs_to_static(0.9, 2.0, parameters));
  CHECK_FALSE(belongs_to_static(0.89, 2.0, parameters));
  CHECK(belongs_to_static(0.5, 2 * 0.2, parameters));
  CHECK_FALSE(belongs_to_static(0.5, 3 * 0.2, parameters));
  CHECK_FALSE(belongs_to_static(0.49, 0.2, parameters));
}

TEST_CASE("neighbouring clusters are judged as one group") {
  // A floor under cluster A only. A and B are two clusters (0.5 m apart, reach 0.3 m) in
  // neighbouring cells of the group rule.
  OccupancyMap map(0.2);
  for (int x = 0; x < 5; ++x) map.insert({x, 0, 0});
  const ScanPoints points = points_at({{0.1, 0.1, 0.3},
                                       {0.3, 0.1, 0.3},
                                       {0.5, 0.1, 0.3},
                                       {0.5, 0.1, 0.79},
                                       {0.5, 0.1, 1.05},
                                       {0.5, 0.1, 1.3}},
                                      1.0);
  Parameters parameters = lenient();
  parameters.cluster_gap = 0.3;
  parameters.cluster_gap_growth = 0.0;
  parameters.coverage_static = 0.9;
  parameters.group_gap = 1;
  // Apart: A is covered (3 of 3) and static, B (0 of 3) dynamic.
  CHECK(validate_candidates(points, map, parameters) == Mask{0, 0, 0, 1, 1, 1});
  // As one group, 3 of 6 points are covered: below 0.9, dynamic.
  parameters.group_gap = 2;
  CHECK(validate_candidates(points, map, parameters) == Mask(6, 1));
}

TEST_CASE("supported points of a dynamic cluster are kept, and small remainders with them") {
  // A column of points in cells z = 0 .. 5 above a floor that is three cells thick around it.
  OccupancyMap map(0.2);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -2; z <= 0; ++z) {
        if (x != 0 || y != 0 || z != 0) map.insert({x, y, z});
      }
    }
  }
  std::vector<Eigen::Vector3d> column;
  for (int z = 0; z < 6; ++z) column.emplace_back(0.1, 0.1, 0.1 + 0.2 * z);
  const ScanPoints points = points_at(column, 1.0);
  // Cell 0 with reach 1: 17 static voxels below and beside it, 2 of the cluster: 0.89. Cell 1:
  // 8 static beside cell 0, 3 of the cluster: 0.73. Cell 2: none.
  OccupancyMap own(0.2);
  for (const VoxelIndex& voxel : points.voxel) own.insert(voxel);
  CHECK(support({0, 0, 0}, map, own, 1) == Approx(17.0 / 19.0));
  CHECK(support({0, 0, 1}, map, own, 1) == Approx(8.0 / 11.0));
  CHECK(support({0, 0, 2}, map, own, 1) == 0.0);
  Parameters parameters = lenient();
  parameters.support_dilation = 1;
  parameters.support_share = 0.8;
  CHECK(validate_candidates(points, map, parameters) == Mask{0, 1, 1, 1, 1, 1});
  parameters.support_share = 0.7;
  CHECK(validate_candidates(points, map, parameters) == Mask{0, 0, 1, 1, 1, 1});
  parameters.minimum_points = 5;  // Four remain.
  CHECK(validate_candidates(points, map, parameters) == Mask(6, 0));
  parameters.minimum_points = 4;
  CHECK(validate_candidates(points, map, parameters) == Mask{0, 0, 1, 1, 1, 1});
  parameters.minimum_width = 0.1;  // The column has no width at all.
  CHECK(validate_candidates(points, map, parameters) == Mask(6, 0));
}

TEST_CASE("a support share of 1 keeps no point, also in a voxel of the static map") {
  OccupancyMap map(0.2);
  for (int z = 0; z < 3; ++z) map.insert({0, 0, z});
  const ScanPoints points = points_at({{0.1, 0.1, 0.1}, {0.1, 0.1, 0.3}, {0.1, 0.1, 0.5}}, 1.0);
  Parameters parameters = lenient();  // The share is 1.
  CHECK(validate_candidates(points, map, parameters) == Mask(3, 1));
  parameters.support_share = 0.95;  // Every voxel around is static.
  CHECK(validate_candidates(points, map, parameters) == Mask(3, 0));
}

TEST_CASE("support equals a count voxel by voxel, across the borders of bricks") {
  std::mt19937 random(4);
  const auto pick = [&] { return static_cast<int>(random() % 24) - 12; };
  OccupancyMap map(0.2), removed(0.2);
  for (int k = 0; k < 3000; ++k) {
    map.insert({pick(), pick(), pick()});
    removed.insert({pick(), pick(), pick()});
  }
  for (int k = 0; k < 200; ++k) {
    const VoxelIndex voxel(pick(), pick(), pick());
    const int dilation = k % 6;
    int in_map = 0, in_removed = 0;
    for_each_around(voxel, dilation, [&](const VoxelIndex& near) {
      if (map.contains(near)) {
        ++in_map;
      } else if (removed.contains(near)) {
        ++in_removed;
      }
    });
    const double expected =
        in_map + in_removed == 0 ? 0.0 : static_cast<double>(in_map) / (in_map + in_removed);
    REQUIRE(support(voxel, map, removed, dilation) == expected);
  }
}

}  // namespace raymoval::raymoval_test
