// SPDX-License-Identifier: MIT
#include "tests/methods/hmm_mos/oracle.h"

#include <catch2/catch.hpp>

#include "methods/hmm_mos/hmm_mos.h"
#include "methods/hmm_mos/moving_voxels.h"
#include "tests/methods/grid_cells.h"
#include "tests/methods/hmm_mos/scenes.h"

namespace raymoval::hmm_mos_test {

namespace {

VoxelIndex voxel(const Cell& cell) {
  return {cell[0], cell[1], cell[2]};
}

/// Settings that differ in all parameters of the steps. Windows are short, to need few scans.
std::vector<Parameters> settings() {
  std::vector<Parameters> all(6);
  for (Parameters& parameters : all) parameters.window_scans = 2;
  all[1].public_lattice = false;
  all[2].voxel_size = 0.2;
  all[2].window_scans = 3;
  all[2].max_range = 3.9;  // Cuts the wall.
  all[2].map_range_factor = 1.0;
  all[3].public_lattice = false;
  all[3].spread = 0.7;
  all[3].transition = 0.02;
  all[3].belief = 0.95;
  all[3].map_scans = 2;
  all[4].reach = 1;
  all[4].least_threshold = 0.0;
  all[4].min_range = 2.6;  // Leaves some moving points out.
  all[5].public_lattice = false;
  all[5].spread = 1.4;
  all[5].map_scans = 1;
  return all;
}

/// Compares what is known after a scan.
void check_map(const Oracle& oracle, const BeliefMap& map) {
  CHECK(map.size() == oracle.map.size());
  std::size_t differences = 0;
  for (const auto& [cell, believed] : oracle.map) {
    const std::uint64_t known = map.known(block_of(voxel(cell)), column_of(voxel(cell)));
    const bool is_known = (known & bit_of(voxel(cell))) != 0;
    differences += is_known != (believed.state != State::kUnobserved) ? 1 : 0;
  }
  CHECK(differences == 0);
}

}  // namespace

TEST_CASE("each step finds what the plain sets find", "[hmm_mos]") {
  int moving_scans = 0;
  unsigned seed = 3;
  for (const Parameters& parameters : settings()) {
    Oracle oracle(parameters);
    BeliefMap map(parameters);
    MovingVoxels moving(parameters);
    ScanVoxels voxels, before;
    const toy::HeldScans scans = wall_and_mover(7, 4, ++seed, 0.07);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      INFO("setting " << seed - 4 << ", scan " << i);
      const Scan scan = scans.load(i);
      oracle.add(scan);
      find_voxels(scan, parameters, {}, voxels);
      CHECK(toy::cells_of(voxels.grid, &Column::hit) == oracle.occupied);
      CHECK(toy::cells_of(voxels.grid, &Column::free) == oracle.observed);
      map.observe(voxels, before, {});
      map.forget(scan.T_world_sensor.translation());
      check_map(oracle, map);
      moving.add(voxels.grid, map);
      std::swap(voxels, before);
      const bool moves = oracle.has_threshold && oracle.threshold > parameters.least_threshold;
      Cells expected, found;
      if (moves) expected = oracle.dynamic;
      for (const VoxelKey key : moving.found()) {
        const VoxelIndex at = voxel_index(key);
        found.insert({at.x(), at.y(), at.z()});
      }
      CHECK(found == expected);
      moving_scans += found.empty() ? 0 : 1;
    }
  }
  CHECK(moving_scans > 6);
}

TEST_CASE("verdicts of hmm_mos are those of the plain sets", "[hmm_mos]") {
  std::size_t removed = 0, kept = 0;
  unsigned seed = 20;
  for (Parameters parameters : settings()) {
    const toy::HeldScans scans = wall_and_mover(6, 4, ++seed, 0.11);
    Oracle oracle(parameters);
    std::vector<Mask> online;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      oracle.add(scans.load(i));
      online.push_back(oracle.mask(scans.load(i)));
    }
    for (const bool offline : {false, true}) {
      INFO("setting " << seed - 21 << ", offline " << offline);
      parameters.offline = offline;
      const MaskStore masks = toy::masks_of(*make_hmm_mos(parameters), scans);
      for (std::size_t i = 0; i < scans.size(); ++i) {
        Mask expected = online[i];
        const Mask free = oracle.last_free(scans.load(i));
        for (std::size_t k = 0; offline && k < expected.size(); ++k) expected[k] |= free[k];
        CHECK(masks.get(i) == expected);
        for (const std::uint8_t verdict : expected) ++(verdict != 0 ? removed : kept);
      }
    }
  }
  CHECK(removed > 100);  // The scenes have both.
  CHECK(kept > 100);
}

}  // namespace raymoval::hmm_mos_test
