// SPDX-License-Identifier: MIT
#include "tests/methods/dufomap/oracle.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/dufomap/beams.h"
#include "methods/dufomap/dufomap.h"
#include "tests/methods/grid_cells.h"
#include "tests/methods/toy_world.h"

namespace raymoval::dufomap_test {
using namespace raymoval::dufomap_method;

namespace {

/// A bundle of beams dense enough for voids, and stray points all around; nothing on a lattice.
toy::HeldScans random_scans(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  toy::HeldScans scans;
  Eigen::Vector3d towards(any(random), any(random), any(random));
  towards *= 3.0 / towards.norm();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d sensor(any(random), any(random), any(random));
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 900; ++k) {
      points.emplace_back(towards * (1.0 + 0.2 * i) +
                          0.5 * Eigen::Vector3d(any(random), any(random), any(random)));
    }
    for (int k = 0; k < 60; ++k) {
      points.emplace_back(9.0 * Eigen::Vector3d(any(random), any(random), any(random)));
    }
    scans.add_world(sensor, points);
  }
  return scans;
}

std::vector<Parameters> settings() {
  std::vector<Parameters> all(7);
  all[1].unknown_inflation = 2;
  all[2].unknown_inflation = 0;
  all[2].hit_extension = 0.0;
  all[3].minimum_range = 2.0;
  all[4].compensate_inflation = false;
  all[5].maximum_range = 2.5;
  all[6].voxel_size = 0.05;
  all[6].unknown_inflation = 3;
  all[6].hit_extension = 0.33;
  return all;
}

}  // namespace

TEST_CASE("hits and free voxels are those of the plain sets") {
  for (const Parameters& parameters : settings()) {
    const Oracle oracle(parameters);
    ScanGrid grid;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const toy::HeldScans scans = random_scans(seed);
      const Scan scan = scans.load(seed % 3);
      grid.clear();
      const auto voxels = voxels_of(scan, parameters.voxel_size);
      cast_beams(scan, beam_ends(scan, voxels, parameters, grid), parameters, grid);
      const ScanSets sets = oracle.sets_of(scan);
      CHECK(toy::cells_of(grid, &Column::hit) == sets.hit);
      CHECK(toy::cells_of(grid, &Column::free) == sets.free);
      std::vector<VoxelIndex> all;  // And the voids among everything that is free.
      for (const Cell& cell : sets.free) all.emplace_back(cell[0], cell[1], cell[2]);
      ScanVoids found;
      find_voids(grid, parameters.unknown_inflation, found);
      VoidMap map;
      map.add(found);
      const Mask inside = map.contain(all);
      std::size_t k = 0, differences = 0;
      for (const Cell& cell : sets.free) {
        differences += inside[k++] != sets.voids.count(cell) ? 1 : 0;
      }
      CHECK(differences == 0);
    }
  }
}

TEST_CASE("verdicts are those of the plain sets") {
  int removed = 0, kept = 0;
  for (Parameters parameters : settings()) {
    for (const bool offline : {true, false}) {
      parameters.offline = offline;
      const toy::HeldScans scans = random_scans(11);
      const auto masks = toy::masks_of(*make_dufomap(parameters), scans);
      const std::vector<Mask> expected = Oracle(parameters).masks(scans);
      for (std::size_t i = 0; i < scans.size(); ++i) {
        CHECK(masks.get(i) == expected[i]);
        for (const std::uint8_t verdict : expected[i]) ++(verdict != 0 ? removed : kept);
      }
    }
  }
  CHECK(removed > 100);  // The scenes have both.
  CHECK(kept > 100);
}

}  // namespace raymoval::dufomap_test
