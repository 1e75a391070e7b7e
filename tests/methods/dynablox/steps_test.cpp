// SPDX-License-Identifier: MIT
// The steps one by one, on voxels and points that are put where they are wanted.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "methods/dynablox/clusters.h"
#include "methods/dynablox/integration.h"
#include "tests/methods/dynablox/oracle.h"
#include "tests/methods/held_scans.h"

namespace raymoval::dynablox_test {
using namespace raymoval::dynablox_method;

namespace {

constexpr double kFar = 1000.0;

/// A scan with a point in the middle of each voxel.
Scan points_in(const std::vector<VoxelIndex>& voxels) {
  Scan scan;
  for (const VoxelIndex& voxel : voxels) {
    scan.points.emplace_back(((voxel.cast<double>().array() + 0.5) * 0.2).cast<float>());
  }
  return scan;
}

/// A map in which these voxels are ever free.
BlockMap map_of(const std::vector<VoxelIndex>& ever_free) {
  BlockMap map;
  for (const VoxelIndex& voxel : ever_free) {
    map.find_or_make(block_of(voxel), {}).ever_free[row_of(voxel)] |= bit_of(voxel);
  }
  return map;
}

/// How many points each cluster has.
std::vector<std::size_t> sizes(const std::vector<VoxelIndex>& ever_free,
                               const std::vector<VoxelIndex>& hit, Parameters parameters) {
  parameters.min_points = 1;
  const Scan scan = points_in(hit);
  ScanVoxels voxels;
  find_voxels(scan, parameters.voxel_size, 0.0, kFar, voxels);
  std::vector<std::size_t> sizes;
  for (const Cluster& cluster : find_clusters(scan, voxels, map_of(ever_free), parameters)) {
    sizes.push_back(cluster.points.size());
  }
  return sizes;
}

using Sizes = std::vector<std::size_t>;

std::vector<VoxelIndex> line(int first, int last) {
  std::vector<VoxelIndex> voxels;
  for (int x = first; x <= last; ++x) voxels.emplace_back(x, 3, 5);
  return voxels;
}

std::vector<VoxelIndex> joined(std::vector<VoxelIndex> a, const std::vector<VoxelIndex>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("dynablox: an arc tangent is right to 1e-6") {
  for (int i = 0; i < 720; ++i) {
    const auto x = static_cast<float>(std::cos(i * 0.5 * kDegree) * (1 + i));
    const auto y = static_cast<float>(std::sin(i * 0.5 * kDegree) * (1 + i));
    CHECK(std::abs(dynablox_test::arc_tangent(y, x) - std::atan2(y, x)) < 1e-6F);
  }
  CHECK(dynablox_test::arc_tangent(0.0F, 0.0F) == 0.0F);
}

TEST_CASE("dynablox: points within range take part") {
  const Scan scan = points_in({{1, 0, 0}, {5, 0, 0}, {40, 0, 0}, {200, 0, 0}});
  ScanVoxels voxels;
  find_voxels(scan, 0.2, 0.5, 20.0, voxels);
  CHECK(voxels.points == std::vector<std::uint32_t>{1, 2});
  CHECK(voxels.hits.contains({40, 0, 0}));
  CHECK_FALSE(voxels.hits.contains({1, 0, 0}));
  CHECK_FALSE(voxels.hits.contains({41, 0, 0}));
}

TEST_CASE("dynablox: the bounds of the range are exact, and belong to it") {
  Scan scan;
  scan.points.emplace_back(3.0F, 4.0F, 0.0F);   // 5 m.
  scan.points.emplace_back(5.0F, 1e-4F, 0.0F);  // 1e-9 m more, which single precision loses.
  ScanVoxels voxels;
  find_voxels(scan, 0.2, 0.5, 5.0, voxels);
  CHECK(voxels.points == std::vector<std::uint32_t>{0});
  find_voxels(scan, 0.2, 5.0, 20.0, voxels);
  CHECK(voxels.points == std::vector<std::uint32_t>{0, 1});
}

TEST_CASE("dynablox: a cluster grows through ever-free voxels and to those beside them") {
  // Ever free: 0 to 3. What lies beyond is taken in once, and once more.
  Parameters parameters;
  CHECK(sizes(line(0, 3), line(0, 9), parameters) == Sizes{5});
  parameters.grow_twice = true;
  CHECK(sizes(line(0, 3), line(0, 9), parameters) == Sizes{6});
  SECTION("not without points between") {
    CHECK(sizes(line(0, 9), joined(line(0, 3), line(5, 9)), parameters) == Sizes{4, 5});
  }
  SECTION("not over a corner, unless corners are neighbours") {
    const std::vector<VoxelIndex> corner = {{0, 0, 0}, {1, 1, 1}};
    parameters.separation = 0.0;
    CHECK(sizes({{0, 0, 0}}, corner, parameters) == Sizes{1});
    parameters.cluster_neighbours = Neighbours::kEdges;
    CHECK(sizes({{0, 0, 0}}, corner, parameters) == Sizes{1});
    parameters.cluster_neighbours = Neighbours::kCorners;
    CHECK(sizes({{0, 0, 0}}, corner, parameters) == Sizes{2});
  }
  SECTION("nothing grows without an ever-free voxel") {
    CHECK(sizes({}, line(0, 9), parameters).empty());
  }
  SECTION("over the wall of a block") {
    CHECK(sizes(line(14, 17), line(14, 17), parameters) == Sizes{4});
    CHECK(sizes(line(-2, 1), line(-2, 1), parameters) == Sizes{4});
  }
}

TEST_CASE("dynablox: clusters near each other are one") {
  Parameters parameters;
  // Ever free 0 and 3: each takes in one of 1 and 2, which are beside each other.
  CHECK(sizes(joined(line(0, 0), line(3, 3)), line(0, 3), parameters) == Sizes{4});
  parameters.separation = 0.1;
  CHECK(sizes(joined(line(0, 0), line(3, 3)), line(0, 3), parameters) == Sizes{2, 2});
  // A gap of one voxel is 0.4 m from centre to centre.
  const std::vector<VoxelIndex> both = joined(line(0, 1), line(3, 4));
  parameters.separation = 0.39;
  CHECK(sizes(both, both, parameters) == Sizes{2, 2});
  parameters.separation = 0.4;
  CHECK(sizes(both, both, parameters) == Sizes{4});
}

TEST_CASE("dynablox: what the public program forgets when it merges") {
  Parameters parameters;
  parameters.separation = 0.4;
  // Three in a row: the first is near the second, the second near the third.
  const std::vector<VoxelIndex> row = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}};
  CHECK(sizes(row, row, parameters) == Sizes{3});
  parameters.public_merges = true;
  CHECK(sizes(row, row, parameters) == Sizes{2, 1});
  // The box of the first one stays that of its own voxel, 0.35 m from corner to corner; that of
  // both were 0.66 m.
  parameters.max_extent = 0.5;
  CHECK(sizes(row, row, parameters) == Sizes{2, 1});
  parameters.public_merges = false;
  CHECK(sizes(row, row, parameters).empty());
  parameters.max_extent = 10.0;
  parameters.public_boxes = true;
  CHECK(sizes(row, row, parameters) == Sizes{3});
  // Its lower end, 1.0 m, above the other's furthest x, 0: not even looked at.
  const std::vector<VoxelIndex> high = {{0, 0, 9}, {2, 0, 9}};
  CHECK(sizes(high, high, parameters) == Sizes{1, 1});
  parameters.public_boxes = false;
  CHECK(sizes(high, high, parameters) == Sizes{2});
}

TEST_CASE("dynablox: points outside the map's blocks are in a cluster, but for the public one") {
  Parameters parameters;
  parameters.grow_twice = true;
  CHECK(sizes(line(15, 15), line(15, 17), parameters) == Sizes{3});
  parameters.public_unmapped = true;
  CHECK(sizes(line(15, 15), line(15, 17), parameters) == Sizes{1});
}

TEST_CASE("dynablox: clusters of few or many points, small or large, are none") {
  Parameters parameters;
  const Scan scan = points_in(line(0, 9));
  ScanVoxels voxels;
  find_voxels(scan, 0.2, 0.0, kFar, voxels);
  const auto is_cluster = [&] {
    return !find_clusters(scan, voxels, map_of(line(0, 9)), parameters).empty();
  };
  parameters.min_points = 10;
  parameters.max_points = 10;
  CHECK(is_cluster());
  parameters.min_points = 11;
  CHECK_FALSE(is_cluster());
  parameters.min_points = 1;
  parameters.max_points = 9;
  CHECK_FALSE(is_cluster());
  parameters.max_points = 10;
  // Nine steps of 0.2 m between the points; the box of the voxels is 2.0 x 0.2 x 0.2 m.
  for (const auto& [extents, extent] :
       {std::pair(Extents::kPoints, 1.8), std::pair(Extents::kVoxels, std::sqrt(4.08))}) {
    parameters.extents = extents;
    parameters.min_extent = extent - 0.01;
    parameters.max_extent = extent + 0.01;
    CHECK(is_cluster());
    parameters.min_extent = 0.0;
    parameters.max_extent = extent - 0.01;
    CHECK_FALSE(is_cluster());
    parameters.max_extent = 10.0;
    parameters.min_extent = extent + 0.01;
    CHECK_FALSE(is_cluster());
  }
}

TEST_CASE("dynablox: a cluster is followed from the nearest one, the closest pair first") {
  std::vector<Cluster> last(3), now(3);
  last[0].centroid = {0, 0, 0};
  last[0].track = 4;
  last[1].centroid = {0.8, 0, 0};
  last[1].track = 7;
  last[2].centroid = {9, 0, 0};
  now[0].centroid = {0.9, 0, 0};  // Nearest to the second, 0.1 m.
  now[1].centroid = {0.6, 0, 0};  // Nearest to the second too, 0.2 m, which is taken.
  now[2].centroid = {7.9, 0, 0};  // 1.1 m from the third.
  follow_clusters(last, 1.0, now);
  CHECK(now[0].track == 8);
  CHECK(now[1].track == 5);
  CHECK(now[2].track == 0);
}

TEST_CASE("dynablox: the image is as large as the sensor says") {
  Parameters parameters;
  const ImageGrid hdl64(parameters, sensor_model_named("hdl64e"));
  CHECK(hdl64.columns == 2083);
  CHECK(hdl64.rows == 64);
  const ImageGrid vlp16(parameters, sensor_model_named("vlp16"));
  CHECK(vlp16.columns == 1800);
  CHECK(vlp16.rows == 16);
  const ImageGrid unknown(parameters, SensorModel{});
  CHECK(unknown.columns == 2048);
  CHECK(unknown.rows == 64);
  parameters.image = ImageSource::kFixed;
  const ImageGrid fixed(parameters, sensor_model_named("vlp16"));
  CHECK(fixed.columns == 2048);
  CHECK(fixed.rows == 64);
  CHECK(fixed.elevation_min == Approx(-16.61 * kDegree));
  CHECK(fixed.rows_per_radian == Approx(63 / (33.22 * kDegree)));
  CHECK(fixed.pixels_per_square_radian == Approx(2048 / kTurn * 64 / (33.22 * kDegree)));
}

TEST_CASE("dynablox: the view is as published where the sensor's is unknown") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [low, high] :
       {std::pair(0.0, 0.0), std::pair(unknown, unknown), std::pair(unknown, 0.1),
        std::pair(-0.1, unknown), std::pair(0.1, -0.1), std::pair(-9.0, 9.0)}) {
    SensorModel sensor;
    sensor.elevation_min = low;
    sensor.elevation_max = high;
    sensor.azimuth_step = unknown;
    sensor.elevation_step = unknown;
    const ImageGrid grid(Parameters{}, sensor);
    CHECK(grid.columns == 2048);
    CHECK(grid.rows == 64);
    CHECK(grid.elevation_min == Approx(-16.61 * kDegree));
    CHECK(grid.rows_per_radian == Approx(63 / (33.22 * kDegree)));
    sensor.elevation_step = 33.22 * kDegree / 15;
    CHECK(ImageGrid(Parameters{}, sensor).rows == 16);
  }
  SensorModel sensor;
  for (const double range : {0.0, unknown}) {
    sensor.range_max = range;
    CHECK(Integrator(Parameters{}, sensor).max_range() == 20.0);
  }
  sensor.range_max = 12.0;
  CHECK(Integrator(Parameters{}, sensor).max_range() == 12.0);
}

TEST_CASE("dynablox: a layer takes 14 bytes a voxel") {
  CHECK(sizeof(Layer) == 14 * kLayer);
}

}  // namespace raymoval::dynablox_test
