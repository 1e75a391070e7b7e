// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/map_cells.h"

#include "eval/scan_passes.h"

namespace raymoval::erasor {
namespace {

struct FoundCells {
  CellSet cells, on_walls, moving;

  void clear() {
    cells.clear();
    on_walls.clear();
    moving.clear();
  }
  void insert(const FoundCells& other) {
    cells.insert(other.cells);
    on_walls.insert(other.on_walls);
    moving.insert(other.moving);
  }
};

/// Adds the cells into which a mean of points like this one, which is on a wall, may be rounded.
void insert_at_wall(const Eigen::Vector3d& point, double inverse, FoundCells& found) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kWallMargin);
  const VoxelIndex low = cell_index(point - margin, inverse);
  const VoxelIndex high = cell_index(point + margin, inverse);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) found.cells.insert(voxel_key(x, y, z));
    }
  }
  found.on_walls.insert(cell_key(point, inverse));
}

/// Whether a point is within `kWallMargin` of a wall of its cell.
bool is_on_wall(const Eigen::Vector3d& point, const VoxelIndex& cell, double size) {
  const Eigen::Vector3d above = point - cell.cast<double>() * size;
  return above.minCoeff() <= kWallMargin || above.maxCoeff() >= size - kWallMargin;
}

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
  const double size = rules.options.voxel_size;
  const double inverse = 1.0 / size;
  CellInserter cells(found.cells);
  visit_placed(scan, rules, false, [&](const Eigen::Vector3d& point, std::uint32_t word) {
    const VoxelIndex cell = cell_index(point, inverse);
    cells.insert(voxel_key(cell));
    if (is_on_wall(point, cell, size)) insert_at_wall(point, inverse, found);
    if (!rules.classes.moving(word) && semantic_id(word) != kMovingTruck) return;
    found.moving.insert(voxel_key(cell));
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
  cells.all = CellLattice(all.cells);
  cells.on_walls = cells_around(all.on_walls, 0, cells.all);
  cells.mixed = cells_around(all.moving, 2, cells.all);
  cells.near_mixed = cells_around(all.moving, 3, cells.all);
  return cells;
}

}  // namespace raymoval::erasor
