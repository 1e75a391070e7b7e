// SPDX-License-Identifier: MIT
#include "benchmark/clean/map_cleaner.h"

#include <catch2/catch.hpp>

#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;

namespace {

/// Three points, seen from x = 10.
Scan scan() {
  Scan result;
  result.T_world_sensor = Pose(Eigen::Translation3d(10.0, 0.0, 0.0));
  result.points = {{0.1F, 0.0F, 0.0F}, {0.3F, 0.0F, 0.0F}, {5.0F, 0.0F, 0.0F}};
  result.reflectance = {0.2F, 0.4F, 1.0F};
  return result;
}

/// The map of `masks`, a scan each, written to a file `name` and read back.
Cloud map_of(const std::string& name, double voxel, const std::vector<Mask>& masks) {
  const test::TemporaryFolder folder;
  MapWriter map(folder.path() / name, voxel);
  for (const Mask& mask : masks) map.add(scan(), mask, 0);
  const std::uint64_t written = map.finish();
  map.commit();
  Cloud cloud = read_cloud(folder.path() / name);
  CHECK(cloud.points.size() == written);
  return cloud;
}

}  // namespace

TEST_CASE("Points of the wanted side are kept in the world frame") {
  for (const char* name : {"map.pcd", "map.ply", "map.bin"}) {
    const Cloud kept = map_of(name, 0.0, {{0, 0, 1}});
    REQUIRE(kept.points.size() == 2);
    CHECK(kept.points[1].x() == Approx(10.3));
    CHECK(kept.intensity == std::vector<float>{0.2F, 0.4F});
  }
}

TEST_CASE("With a voxel size each cell gives its mean, in order of cells") {
  for (const char* name : {"map.pcd", "map.ply", "map.bin"}) {
    // 10.1 and 10.3 share [10, 10.5); 15 is a cell of its own.
    const Cloud kept = map_of(name, 0.5, {{1, 1, 0}, {0, 0, 0}});
    REQUIRE(kept.points.size() == 2);
    CHECK(kept.points[0].x() == Approx(10.2));
    CHECK(kept.points[1].x() == Approx(15.0));
    CHECK(kept.intensity[0] == Approx(0.3));
  }
}

TEST_CASE("A map of nothing is a whole file without points") {
  for (const double voxel : {0.0, 0.5}) {
    CHECK(map_of("map.pcd", voxel, {}).points.empty());
    CHECK(map_of("map.ply", voxel, {{1, 1, 1}}).points.empty());
  }
}

TEST_CASE("A scan without reflectance leaves the field out, or 0 in a map that is under way") {
  const test::TemporaryFolder folder;
  Scan bare = scan();
  bare.reflectance.clear();
  const auto reflectance = [&](double voxel, const Scan& first, const Scan& second) {
    MapWriter map(folder.path() / "map.pcd", voxel);
    map.add(first, {0, 1, 1}, 0);
    map.add(second, {0, 1, 1}, 0);
    map.finish();
    map.commit();
    return read_cloud(folder.path() / "map.pcd").intensity;
  };
  CHECK(reflectance(0.0, bare, scan()).empty());
  CHECK(reflectance(0.0, scan(), bare) == std::vector<float>{0.2F, 0.0F});
  CHECK(reflectance(0.5, scan(), bare).empty());
}
