// SPDX-License-Identifier: MIT
// Each inequality of the paper exactly at its bound, and each rounding half way.
#include <catch2/catch.hpp>

#include "core/angle.h"
#include "methods/common/range_adaptive_clusters.h"
#include "methods/raymoval/consistency.h"
#include "methods/raymoval/scan_against_map.h"
#include "methods/raymoval/validation.h"

namespace raymoval::raymoval_test {
using namespace raymoval::raymoval_method;

namespace {

/// Points in voxels of 0.2 m.
ScanPoints voxel_points(const std::vector<VoxelIndex>& voxels, double range = 1.0) {
  ScanPoints points;
  for (const VoxelIndex& voxel : voxels) {
    points.position.push_back((voxel.cast<double>().array() + 0.5) * 0.2);
    points.voxel.push_back(voxel);
    points.range.push_back(range);
  }
  return points;
}

/// Settings under which nothing is given back.
Parameters give_nothing_back() {
  Parameters parameters;
  parameters.cluster_points = 0;
  parameters.coverage_static = 1.01;
  parameters.coverage_edge = 1.01;
  parameters.support_share = 1;
  parameters.minimum_points = 0;
  return parameters;
}

}  // namespace

TEST_CASE("grids of the sensor's steps have as many bins as the steps need", "[raymoval]") {
  Parameters parameters;
  parameters.azimuth_bins = parameters.elevation_bins = 0;
  parameters.elevation_margin = 0;
  SensorModel sensor;
  sensor.elevation_min = -0.3;
  sensor.elevation_max = 0.1;
  const auto grid = [&](double azimuth_bins, double elevation_bins) {
    sensor.azimuth_step = kTurn / azimuth_bins;
    sensor.elevation_step = 0.4 / elevation_bins;
    const AngularGrid made = grid_for(sensor, parameters);
    return std::pair(made.azimuth_bins, made.elevation_bins);
  };
  CHECK(grid(1000.5, 64.5) == std::pair(1001, 65));
  CHECK(grid(35.5, 36.5) == std::pair(36, 37));
  CHECK(grid(10, 10) == std::pair(36, 36));
  CHECK(grid(1e6, 1e6) == std::pair(7200, 720));
  sensor.azimuth_step = sensor.elevation_step = 0.0;  // Unknown.
  CHECK(grid_for(sensor, parameters).azimuth_bins == 720);
  CHECK(grid_for(sensor, parameters).elevation_bins == 450);
}

TEST_CASE("eq. 9: half way between two ranks the higher one is taken", "[raymoval]") {
  const std::vector<float> sorted = {1, 2, 3};
  CHECK(percentile_of_sorted(sorted.data(), 2, 0.5) == 2);
  CHECK(percentile_of_sorted(sorted.data(), 2, 0.495) == 1);
  CHECK(percentile_of_sorted(sorted.data(), 3, 0.25) == 2);
  CHECK(percentile_of_sorted(sorted.data(), 3, 0.2475) == 1);
  CHECK(percentile_of_sorted(sorted.data(), 3, 0.75) == 3);
}

TEST_CASE("eqs 8-9: both percentiles have the window's radius", "[raymoval]") {
  const AngularGrid grid{64, 9, 0.0, 0.3};
  std::vector<float> values;
  for (int bin = 0; bin < grid.size(); ++bin) values.push_back(static_cast<float>(bin * 37 % 101));
  for (const int radius : {0, 1, 2, 3}) {
    WindowPercentiles found;
    windowed_percentiles(values, values, grid, radius, {0.9, 0.1}, 1, found);
    CHECK(found.first == windowed_percentile(values, grid, radius, 0.9, 1));
    CHECK(found.second == windowed_percentile(values, grid, radius, 0.1, 1));
  }
}

TEST_CASE("eq. 11 at its bound, in the first bin and in none", "[raymoval]") {
  // 4 m: the margin is 0.5 + 0.25 * 4 = 1.5 m, and the maps are 1.5 m and a little more behind.
  ProjectedScan scan;
  Mask expected;
  for (int k = 0; k < 64; ++k) {
    scan.range.push_back(4.0F);
    scan.bin.push_back(k % 4 - 1);
    expected.push_back(k % 4 == 1 ? 1 : 0);
  }
  const std::vector<float> reference = {5.5009766F, 5.5F, kNoRange};
  CHECK(check_consistency(scan, reference, {0.5, 0.25}) == expected);
}

TEST_CASE("a bin is seen through beyond the margins and not at them", "[raymoval]") {
  // Margins 1 + 0.5 * 10 = 6 m at the map reference and 1 m at the own first hit.
  struct Case {
    float nearest, first_hit, reference;
    bool through;
  };
  const std::vector<Case> cases = {
      {16.0F, 10.0F, 10.0F, false},    {16.5F, 10.0F, 10.0F, true},
      {17.0F, 16.0F, 10.0F, false},    {17.0F, 15.9F, 10.0F, true},
      {17.0F, kNoRange, 10.0F, false}, {16.001F, 10.0F, 10.0F, true},
      {17.0F, 15.9995F, 10.0F, true},  {301.1F, 10.0F, 200.0F, true},
      {11.0F, 9.0F, 10.0F, false},
  };
  ProjectedScan scan;
  FirstHitImage hits;
  const BinWindow alone{{99, 1, 0.0, 0.1}, 0, 0};
  std::vector<float> reference;
  std::vector<int> expected;
  for (int bin = 0; bin < 99; ++bin) {
    const Case& at = cases[static_cast<std::size_t>(bin) % cases.size()];
    scan.minimum_range.push_back(bin < 90 ? at.nearest : kNoRange);
    hits.range.push_back(at.first_hit);
    reference.push_back(at.reference);
    if (at.through && bin < 90) expected.push_back(bin);
  }
  std::vector<int> found;
  for (const SeenThrough& through :
       find_seen_through(scan, alone, hits, reference, {1.0, 0.5}, 1)) {
    found.push_back(through.bin);
  }
  CHECK(found == expected);
}

TEST_CASE("points as far apart as the reach are one cluster, and no farther", "[raymoval]") {
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {0.5, 0, 0}, {1.0009765625, 0, 0}};
  CHECK(range_adaptive_clusters(points, {8, 8, 8}, 0.25, 0.03125) == std::vector<int>{0, 0, 1});
  // In one cell if cells were a little larger: 1.037 m apart, reach 1 m.
  const std::vector<Eigen::Vector3d> corners = {{0.001, 0.001, 0.001}, {0.6, 0.6, 0.6}};
  CHECK(range_adaptive_clusters(corners, {1, 1}, 1.0, 0.0) == std::vector<int>{0, 1});
}

TEST_CASE("eq. 13: the median range decides, and none below a metre", "[raymoval]") {
  Parameters parameters = give_nothing_back();
  parameters.cluster_points = 12;
  CHECK(cluster_points_at(2.0, parameters) == Approx(12 * 25));
  CHECK(cluster_points_at(1.25, parameters) == Approx(12 * 64));
  CHECK(cluster_points_at(1.0, parameters) == Approx(1200));
  CHECK(cluster_points_at(0.25, parameters) == Approx(1200));
  // m(10) = 12 and m(20) = 3. Of an even number the farther one of the middle two decides.
  ScanPoints points = voxel_points({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}});
  points.range = {10, 20, 20, 20};
  CHECK(passes_cluster_screen({0, 1, 2}, points, parameters));
  points.range = {20, 10, 20, 20};  // In any order.
  CHECK(passes_cluster_screen({0, 1, 2}, points, parameters));
  points.range = {10, 10, 20, 20};
  CHECK(passes_cluster_screen({0, 1, 2, 3}, points, parameters));
  CHECK_FALSE(passes_cluster_screen({0, 1, 2}, points, parameters));
  // As wide as d(r) is wide enough.
  parameters.cluster_width = 0.5;
  points.position = {{0, 0, 0}, {0.5, 0, 0}, {0.5, 0, 0}, {0, 0, 9}};
  points.range = {20, 20, 20, 20};
  CHECK(passes_cluster_screen({0, 1, 2}, points, parameters));
  points.position[1].x() = points.position[2].x() = 0.4990234375;
  CHECK_FALSE(passes_cluster_screen({0, 1, 2}, points, parameters));
}

TEST_CASE("eq. 15: a side of so many voxels is as thick as they are", "[raymoval]") {
  Parameters parameters = give_nothing_back();
  parameters.coverage_edge = 0.5;
  parameters.thin_side = 0.6;
  CHECK(3 * 0.2 > 0.6);  // In double.
  CHECK(belongs_to_static(0.5, 3 * 0.2, parameters));
  CHECK_FALSE(belongs_to_static(0.5, 0.65, parameters));
  // A slab of 3 x 3 voxels, one or two layers thick, all of it beside the static map.
  parameters.coverage_dilation = 2;
  for (const int layers : {1, 2}) {
    std::vector<VoxelIndex> slab;
    OccupancyMap map(0.2);
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        map.insert({x, y, -1});
        for (int z = 0; z < layers; ++z) slab.emplace_back(x, y, z);
      }
    }
    const auto stays_dynamic = [&](double thin) {
      parameters.thin_side = thin;
      const Mask dynamic = validate_candidates(voxel_points(slab), map, parameters);
      CHECK((dynamic == Mask(slab.size(), 0) || dynamic == Mask(slab.size(), 1)));
      return dynamic[0] == 1;
    };
    CHECK_FALSE(stays_dynamic(0.2 * layers));
    CHECK(stays_dynamic(0.2 * layers - 0.01));
  }
}

TEST_CASE("a support of exactly the share is support, within its own reach", "[raymoval]") {
  // A voxel between one static voxel and one of the cluster, itself removed: a third is static.
  OccupancyMap map(0.2);
  map.insert({0, 0, -1});
  map.insert({0, 0, -2});  // Only within two cells.
  const ScanPoints points = voxel_points({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}});
  Parameters parameters = give_nothing_back();
  parameters.coverage_dilation = 2;  // Not the support's.
  parameters.support_dilation = 1;
  parameters.support_share = 1.0 / 3.0;
  CHECK(validate_candidates(points, map, parameters) == Mask{0, 1, 1});
  parameters.support_share = 0.34;
  CHECK(validate_candidates(points, map, parameters) == Mask{1, 1, 1});
}

TEST_CASE("a flat remainder is as wide as it is long", "[raymoval]") {
  const ScanPoints points = voxel_points({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  Parameters parameters = give_nothing_back();
  parameters.minimum_width = 0.5;  // It is 0.6 m wide, and has no other side.
  const OccupancyMap nothing(0.2);
  CHECK(validate_candidates(points, nothing, parameters) == Mask(4, 1));
  parameters.minimum_width = 0.7;
  CHECK(validate_candidates(points, nothing, parameters) == Mask(4, 0));
}

TEST_CASE("clusters in one voxel, or with voxels beside each other, are one group", "[raymoval]") {
  const VoxelKey here = voxel_key(0, 0, 0), beside = voxel_key(1, 1, 1), far = voxel_key(3, 0, 0);
  CHECK(voxel_components({here, far, here, beside}, 1) == std::vector<int>{0, 1, 0, 0});
  // Cluster 0 has elements in components 0 and 1, cluster 1 in component 2 alone.
  CHECK(joined_groups({0, 0, 1}, {0, 1, 2}) == std::vector<int>{0, 0, 2});
  CHECK(joined_groups({0, 1, 0}, {0, 1, 1}) == std::vector<int>{0, 0, 0});
  CHECK(joined_groups({0, 1}, {1, 0}) == std::vector<int>{1, 0});
}

TEST_CASE("the rows reach beyond the sensor's view by the margin, and not beyond the poles",
          "[raymoval]") {
  constexpr double kHalfPi = 1.5707963267948966;
  Parameters parameters;
  parameters.elevation_margin = 9.0;  // A twentieth of pi.
  SensorModel sensor;
  sensor.elevation_min = -0.3;
  sensor.elevation_max = 0.1;
  CHECK(grid_for(sensor, parameters).elevation_min == Approx(-0.3 - kHalfPi / 10));
  CHECK(grid_for(sensor, parameters).elevation_max == Approx(0.1 + kHalfPi / 10));
  sensor.elevation_min = -1.5;
  sensor.elevation_max = 1.45;
  CHECK(grid_for(sensor, parameters).elevation_min == -kHalfPi);
  CHECK(grid_for(sensor, parameters).elevation_max == kHalfPi);
  // Given numbers of bins take precedence over the sensor's steps.
  sensor.azimuth_step = sensor.elevation_step = 0.01;
  parameters.azimuth_bins = parameters.elevation_bins = 1;
  CHECK(grid_for(sensor, parameters).size() == 1);
}

TEST_CASE("no points are not covered", "[raymoval]") {
  OccupancyMap map(0.2);
  map.insert({0, 0, 0});
  CHECK(coverage({}, voxel_points({}), map, 1) == 0.0);
  CHECK(validate_candidates(voxel_points({}), map, give_nothing_back()).empty());
}

}  // namespace raymoval::raymoval_test
