// SPDX-License-Identifier: MIT
// The steps one by one, on voxels and points that are put where they are wanted.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "methods/dynablox/field.h"
#include "methods/dynablox/voxels.h"
#include "tests/methods/dynablox/oracle.h"
#include "tests/methods/held_scans.h"

namespace raymoval::dynablox_test {
using namespace raymoval::dynablox_method;

namespace {

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
    insert(voxel, map.find_or_make(block_of(voxel), block_of(voxel)).ever_free);
  }
  return map;
}

/// How many points each cluster has.
std::vector<std::size_t> sizes(const std::vector<VoxelIndex>& ever_free,
                               const std::vector<VoxelIndex>& hit, Parameters parameters) {
  parameters.min_points = 1;
  ScanVoxels voxels;
  find_voxels(points_in(hit), parameters.voxel_size, voxels);
  std::vector<std::size_t> sizes;
  for (const Cluster& cluster : find_clusters(voxels, map_of(ever_free), parameters)) {
    sizes.push_back(cluster.size());
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

TEST_CASE("dynablox: the voxels of a scan's points") {
  ScanVoxels voxels;
  find_voxels(points_in({{1, 0, 0}, {5, 0, 0}, {40, 0, 0}}), 0.2, voxels);
  CHECK(voxels.voxels == std::vector<VoxelIndex>{{1, 0, 0}, {5, 0, 0}, {40, 0, 0}});
  const BlockBits& first = *voxels.hits.find({0, 0, 0});
  CHECK(contains(first, {1, 0, 0}));
  CHECK(contains(first, {5, 0, 0}));
  CHECK_FALSE(contains(first, {6, 0, 0}));
  CHECK(contains(*voxels.hits.find({2, 0, 0}), {40, 0, 0}));
  CHECK(voxels.hits.find({1, 0, 0}) == nullptr);
}

TEST_CASE("dynablox: a cluster grows through ever-free voxels and to those beside them") {
  // Ever free: 0 to 3. The cells beyond are added once.
  Parameters parameters;
  CHECK(sizes(line(0, 3), line(0, 9), parameters) == Sizes{5});
  SECTION("not without points between") {
    CHECK(sizes(line(0, 9), joined(line(0, 3), line(5, 9)), parameters) == Sizes{4, 5});
  }
  SECTION("not over an edge or a corner") {
    parameters.separation = 0.0;
    CHECK(sizes({{0, 0, 0}}, {{0, 0, 0}, {0, 1, 1}, {1, 1, 1}}, parameters) == Sizes{1});
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

TEST_CASE("dynablox: a cluster may reach outside the blocks of the map") {
  CHECK(sizes(line(15, 15), line(15, 17), Parameters{}) == Sizes{2});
}

TEST_CASE("dynablox: clusters of few points are none") {
  ScanVoxels voxels;
  find_voxels(points_in(line(0, 9)), 0.2, voxels);
  Parameters parameters;
  parameters.min_points = 10;
  CHECK(find_clusters(voxels, map_of(line(0, 9)), parameters).size() == 1);
  parameters.min_points = 11;
  CHECK(find_clusters(voxels, map_of(line(0, 9)), parameters).empty());
}

TEST_CASE("dynablox: the image is as large as the sensor says") {
  const ImageGrid hdl64(sensor_model_named("hdl64e"));
  CHECK(hdl64.columns == 2083);
  CHECK(hdl64.rows == 64);
  const ImageGrid vlp16(sensor_model_named("vlp16"));
  CHECK(vlp16.columns == 1800);
  CHECK(vlp16.rows == 16);
  CHECK(vlp16.pixels_per_square_radian == Approx(1800 / kTurn * 16 / (30 * kDegree)));
  const ImageGrid unknown(SensorModel{});
  CHECK(unknown.columns == 2048);
  CHECK(unknown.rows == 64);
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
    const ImageGrid grid(sensor);
    CHECK(grid.columns == 2048);
    CHECK(grid.rows == 64);
    CHECK(grid.elevation_min == Approx(-16.61 * kDegree));
    CHECK(grid.rows_per_radian == Approx(63 / (33.22 * kDegree)));
    sensor.elevation_step = 33.22 * kDegree / 15;
    CHECK(ImageGrid(sensor).rows == 16);
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
