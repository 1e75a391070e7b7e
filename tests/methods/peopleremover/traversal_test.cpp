// SPDX-License-Identifier: MIT
#include "methods/peopleremover/beams.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "tests/methods/peopleremover/slow_path.h"

namespace raymoval::peopleremover_test {
using namespace raymoval::peopleremover_method;

namespace {

using Voxels = std::set<VoxelKey>;

BrickMap map_of(const Voxels& voxels) {
  CellSet cells;
  for (const VoxelKey key : voxels) cells.insert(key);
  return BrickMap(cells);
}

Voxels voxels_of(const BrickMap& map, const std::vector<BrickWord>& words) {
  Voxels voxels;
  for (BrickId brick = 0; brick < words.size(); ++brick) {
    for (int bit = 0; bit < 64; ++bit) {
      if ((words[brick] >> bit & 1U) == 0) continue;
      voxels.insert(voxel_key(voxel_of_bit(map.index_of(brick), bit)));
    }
  }
  return voxels;
}

/// Voxels freed by one beam.
Voxels freed_by(const Voxels& occupied, const Voxels& own, const Eigen::Vector3d& from,
                const Eigen::Vector3d& to) {
  const BrickMap map = map_of(occupied);
  FreedVoxels freed(map.size());
  VoxelMarks marks(map.size());
  BrickFinder finder(map);
  for (const VoxelKey key : own) {
    marks.set(finder.find(brick_of(voxel_index(key))), voxel_bit(voxel_index(key)));
  }
  BeamWalker(map, freed, marks).walk(from, to);
  return voxels_of(map, freed.words());
}

Voxels cube(int half) {
  Voxels voxels;
  for (int z = -half; z < half; ++z) {
    for (int y = -half; y < half; ++y) {
      for (int x = -half; x < half; ++x) voxels.insert(voxel_key(x, y, z));
    }
  }
  return voxels;
}

}  // namespace

TEST_CASE("a beam visits the voxels of single steps, both ends included", "[peopleremover]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> side(-14.0, 14.0);
  const Voxels all = cube(14);
  const BrickMap map = map_of(all);
  const VoxelMarks none(map.size());
  for (int beam = 0; beam < 2000; ++beam) {
    Eigen::Vector3d from(side(random), side(random), side(random));
    Eigen::Vector3d to(side(random), side(random), side(random));
    // Some start or end on walls and corners, some run along an axis or a diagonal.
    if (beam % 4 == 1) from = from.array().floor();
    if (beam % 4 == 2) to[beam % 3] = from[beam % 3];
    if (beam % 4 == 3) {
      from = from.array().floor();
      to = to.array().floor();
    }
    if (beam % 8 == 3) to = from + Eigen::Vector3d(3, -3, 3).cwiseProduct(from.cwiseSign()) * -1;
    FreedVoxels freed(map.size());
    BeamWalker(map, freed, none).walk(from, to);
    std::vector<VoxelKey> path = slow_path(from, to);
    std::erase_if(path, [&](VoxelKey voxel) { return !all.contains(voxel); });
    INFO("from " << from.transpose() << " to " << to.transpose());
    if (from == to) {
      CHECK(voxels_of(map, freed.words()).empty());
    } else {
      REQUIRE(voxels_of(map, freed.words()) == Voxels(path.begin(), path.end()));
    }
  }
}

TEST_CASE("a beam of any length and direction visits the walls between its ends",
          "[peopleremover]") {
  const Voxels all = cube(4);
  std::vector<double> places = {0.0, -1.0, 2.0, 0.5};
  for (const double tiny : {5e-324, 1e-310, 1e-162, 1e-27, 1e-17}) {
    places.push_back(tiny);
    places.push_back(-tiny);
  }
  // Of all three axes from walls and beside them, among them corners and lines along an axis.
  std::mt19937 random(12);
  const auto place = [&] { return places[random() % places.size()]; };
  for (int beam = 0; beam < 3000; ++beam) {
    const Eigen::Vector3d from(place(), place(), place()), to(place(), place(), place());
    INFO("from " << from.transpose() << " to " << to.transpose());
    const Voxels freed = freed_by(all, {}, from, to);
    if (from == to) {
      CHECK(freed.empty());
      continue;
    }
    const Eigen::Vector3i first = from.array().floor().cast<int>();
    const Eigen::Vector3i last = to.array().floor().cast<int>();
    CHECK(freed.contains(voxel_key(first)));
    CHECK(freed.contains(voxel_key(last)));
    CHECK(freed.size() == 1 + static_cast<std::size_t>((last - first).cwiseAbs().sum()));
  }
}

}  // namespace raymoval::peopleremover_test
