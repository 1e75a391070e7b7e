// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/map_cells.h"

#include <utility>

#include "eval/scan_passes.h"

namespace raymoval::erasor {
namespace {

struct FoundCells {
  CellSet cells, moving;

  void clear() {
    cells.clear();
    moving.clear();
  }
  void insert(const FoundCells& other) {
    cells.insert(other.cells);
    moving.insert(other.moving);
  }
};

/// The cells of `lattice` that are at most `steps` cells from one of `centres` along each axis.
RankedBits cells_around(const CellSet& centres, int steps, const CellLattice& lattice) {
  RankedBits around(lattice.size());
  CellLattice::Cursor cursor;
  centres.for_each([&](VoxelKey centre) {
    for (int z = -steps; z <= steps; ++z) {
      for (int y = -steps; y <= steps; ++y) {
        for (int x = -steps; x <= steps; ++x) {
          const auto number = lattice.find(cell_beside(centre, x, y, z), cursor);
          if (number != CellLattice::kNone) around.set(number);
        }
      }
    }
  });
  around.count_through();
  return around;
}

void find_cells(const CheckedScan& scan, const MapRules& rules, FoundCells& found) {
  const double inverse = 1.0 / rules.options.voxel_size;
  CellInserter cells(found.cells);
  visit_placed(scan, rules, false, [&](const Eigen::Vector3d& point, std::uint32_t word) {
    const VoxelKey cell = cell_key(point, inverse);
    cells.insert(cell);
    if (!rules.classes.moving(word) && semantic_id(word) != kMovingTruck) return;
    found.moving.insert(cell);
  });
}

}  // namespace

MapCells map_cells(const MapRules& rules) {
  std::vector<FoundCells> slots(usual_slots(rules.input));
  FoundCells all;
  in_scan_order(
      rules.input, "cells of the map", slots.size(),
      [&](std::size_t scan, std::size_t slot) {
        slots[slot].clear();
        find_cells(load_checked(rules.input, nullptr, scan), rules, slots[slot]);
      },
      [&](std::size_t slot) { all.insert(slots[slot]); });
  MapCells cells;
  cells.all = CellLattice(std::move(all.cells));
  cells.mixed = cells_around(all.moving, 2, cells.all);
  cells.near_mixed = cells_around(all.moving, 3, cells.all);
  return cells;
}

}  // namespace raymoval::erasor
