// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "methods/freedom/maps.h"

namespace raymoval::freedom_test {
using namespace raymoval::freedom_method;

namespace {

/// The middle of the voxel's sub-voxel (2, 2, 2), off all walls.
Eigen::Vector3f middle(int x, int y = 0, int z = 0) {
  return ((VoxelIndex(x, y, z).cast<double>().array() + 0.625) * 0.4).matrix().cast<float>();
}

ScanMap scan_of(const std::vector<Eigen::Vector3f>& points) {
  Scan scan;
  scan.points = points;
  Parameters parameters;
  parameters.minimum_range = 0.0;
  ScanMap voxels;
  voxels.fill(scan, parameters);
  return voxels;
}

/// A scan with points in the middle of voxels along x, all with one level.
ScanMap row_of(const std::vector<int>& voxels, Level level = Level::kStatic) {
  std::vector<Eigen::Vector3f> points;
  for (const int x : voxels) points.push_back(middle(x));
  ScanMap scan = scan_of(points);
  for (ScanVoxel& voxel : scan.voxels()) voxel.level = level;
  return scan;
}

/// The levels of the middle sub-voxels along x, a letter each.
std::string levels(const StaticMap& map, int count) {
  std::string text;
  for (int x = 0; x < count; ++x) {
    const auto level = static_cast<std::size_t>(map.level_of({4 * x + 2, 2, 2}));
    text += "SAMC-"[level];
  }
  return text;
}

}  // namespace

TEST_CASE("freedom: sub-voxels lie in their voxels on both sides of the origin") {
  for (int i = -9; i <= 9; ++i) {
    const VoxelIndex sub_voxel(i, -i, i + 1), voxel = voxel_of(sub_voxel);
    CHECK(voxel.x() == (i >= 0 ? i / 4 : -((-i + 3) / 4)));
    const int place = place_of(sub_voxel);
    CHECK((place >= 0 && place < 64));
    CHECK(sub_voxel_at(voxel, place) == sub_voxel);
  }
}

TEST_CASE("freedom: a scan's voxels have the mean of their points, and those in range only") {
  Scan scan;
  scan.T_world_sensor.translation() << 0.0, 0.0, 50.0;
  scan.points = {{4.15F, 0.05F, 0.15F}, {4.35F, 0.05F, 0.35F}, {2.6F, 0.0F, 0.0F},
                 {81.0F, 0.0F, 0.0F},   {3.0F, 0.0F, 21.0F},   {3.0F, 0.0F, -21.0F},
                 {-4.1F, 0.1F, 0.1F}};
  ScanMap voxels;
  voxels.fill(scan, {});
  REQUIRE(voxels.voxels().size() == 2);
  const ScanVoxel& first = voxels.voxels()[0];
  CHECK(first.at == VoxelIndex(10, 0, 125));
  CHECK((first.mean() - Eigen::Vector3d(10.625, 0.125, 125.625)).norm() < 1e-5);
  CHECK(first.sub_voxels ==
        (std::uint64_t{1} << 17 | std::uint64_t{1} << 51));  // (1,0,1), (3,0,3).
  CHECK(voxels.voxels()[1].at == VoxelIndex(-11, 0, 125));
}

TEST_CASE("freedom: in a scan levels grow over three neighbours") {
  ScanMap scan = row_of({0, 1, 2, 3, 4, 6});
  scan.voxels()[0].level = Level::kConservative;
  scan.grow();
  std::string text;
  for (const ScanVoxel& voxel : scan.voxels()) {
    text += "SAMC-"[static_cast<std::size_t>(voxel.level)];
  }
  CHECK(text == "CMAASS");
}

TEST_CASE("freedom: a point replaces those of a higher level only") {
  StaticMap map;
  map.integrate(row_of({0}, Level::kModerate), 0);
  CHECK(levels(map, 1) == "M");
  map.integrate(row_of({0}, Level::kConservative), 1);
  CHECK(levels(map, 1) == "M");
  map.integrate(row_of({0}, Level::kAggressive), 2);
  CHECK(levels(map, 1) == "A");
  map.integrate(row_of({0}), 3);
  map.integrate(row_of({0}, Level::kAggressive), 4);
  CHECK(levels(map, 1) == "S");
  // The point belongs to scan 3: it is removed with that scan's points in newly free voxels.
  map.integrate(row_of({1, 2}), 4);
  map.remove({{1, 0, 0}});
  CHECK(levels(map, 3) == "S--");
}

TEST_CASE("freedom: in the map levels grow among points of one scan, over two neighbours") {
  StaticMap map;
  map.integrate(row_of({0, 1, 2, 3, 4}), 0);
  map.integrate(scan_of({middle(2) + Eigen::Vector3f(0.1F, 0.0F, 0.0F)}), 1);
  map.remove({{0, 0, 0}});
  // Without a static point left a voxel is emptied; where scan 1 has one, scan 0's is aggressive.
  CHECK(levels(map, 5) == "--ASS");
  CHECK(map.level_of({4 * 2 + 3, 2, 2}) == Level::kStatic);

  StaticMap other;
  other.integrate(row_of({0, 2, 3}), 0);
  other.integrate(row_of({1}), 1);  // Another scan's: scan 0 does not go on behind it.
  other.remove({{0, 0, 0}});
  CHECK(levels(other, 4) == "-SSS");
}

TEST_CASE("freedom: what was emptied takes any point again, and is not in the map till then") {
  StaticMap map;
  map.integrate(row_of({0, 5}), 0);
  map.remove({{0, 0, 0}, {9, 9, 9}});
  CHECK(levels(map, 6) == "-----S");
  const CellSet removed = map.removed();
  CHECK(removed.contains(voxel_key(2, 2, 2)));
  CHECK_FALSE(removed.contains(voxel_key(22, 2, 2)));
  CHECK_FALSE(removed.contains(voxel_key(3, 2, 2)));  // There never was a point.
  map.integrate(row_of({0}, Level::kConservative), 1);
  CHECK(levels(map, 1) == "C");
  CHECK(map.removed().contains(voxel_key(2, 2, 2)));
  map.integrate(row_of({0}), 2);
  CHECK_FALSE(map.removed().contains(voxel_key(2, 2, 2)));
}

TEST_CASE("freedom: sub-voxels stay in order whatever comes first") {
  StaticMap map;
  for (int i = 0; i < 64; ++i) {
    const int place = i * 37 % 64;
    const Eigen::Vector3f point(0.05F + 0.1F * static_cast<float>(place / 16),
                                0.05F + 0.1F * static_cast<float>(place / 4 % 4),
                                0.05F + 0.1F * static_cast<float>(place % 4));
    ScanMap scan = scan_of({point});
    scan.voxels()[0].level = place % 3 == 0 ? Level::kStatic : Level::kModerate;
    map.integrate(scan, static_cast<std::size_t>(i));
  }
  for (int place = 0; place < 64; ++place) {
    const VoxelIndex at(place / 16, place / 4 % 4, place % 4);
    CHECK(map.level_of(at) == (place % 3 == 0 ? Level::kStatic : Level::kModerate));
  }
  CHECK(map.size() == 1);
}

}  // namespace raymoval::freedom_test
