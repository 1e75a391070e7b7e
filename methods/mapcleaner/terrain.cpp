// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/terrain.h"

#include <algorithm>
#include <utility>

#include "core/angle.h"
#include "core/parallel.h"
#include "core/sampling.h"

namespace raymoval::mapcleaner_method {
namespace {

/// The search over the terrain, from below the sensors.
class Way {
 public:
  Way(const HeightGrid& grid, double cell, double slope)
      : grid_(grid), inverse_cell_(1.0 / cell), steepest_(std::tan(std::min(slope, kTurn / 4.0))) {}

  /// Whether a cell has a height and is not too steep.
  [[nodiscard]] bool is_passable(const VoxelIndex& cell) {
    return !std::isnan(height(cell)) && !is_too_steep(gradient(cell) - lean_);
  }
  [[nodiscard]] bool is_too_steep(const Eigen::Vector2d& gradient) const {
    return !(gradient.norm() < steepest_);
  }
  /// The gradient of a cell with a height: metres up per metre along x and y.
  [[nodiscard]] Eigen::Vector2d gradient(const VoxelIndex& cell) {
    return {rise(cell, VoxelIndex::UnitX()), rise(cell, VoxelIndex::UnitY())};
  }
  /// From now on, slopes are relative to this gradient.
  void set_lean(const Eigen::Vector2d& gradient) { lean_ = gradient; }
  [[nodiscard]] double height(const VoxelIndex& cell) { return grid_.get(cell, cursor_); }

  /// Searches from a cell, unless it was reached before.
  void go_from(const VoxelIndex& start, HeightGrid& reached) {
    HeightGrid::Cursor cursor;
    const auto reach = [&](const VoxelIndex& cell) {
      if (!std::isnan(reached.get(cell, cursor)) || !is_passable(cell)) return;
      reached.make(cell, cursor) = height(cell);
      next_.push_back(cell);
    };
    reach(start);
    while (!next_.empty()) {
      const VoxelIndex cell = next_.back();
      next_.pop_back();
      for (int k = 0; k < 9; ++k) reach(cell + VoxelIndex(k % 3 - 1, k / 3 - 1, 0));
    }
  }

 private:
  /// Metres up per metre along an axis: over both neighbours, or to the only one with a height.
  [[nodiscard]] double rise(const VoxelIndex& cell, const VoxelIndex& step) {
    const double here = height(cell), before = height(cell - step), after = height(cell + step);
    if (!std::isnan(before) && !std::isnan(after)) return 0.5 * (after - before) * inverse_cell_;
    if (!std::isnan(after)) return (after - here) * inverse_cell_;
    return std::isnan(before) ? 0.0 : (here - before) * inverse_cell_;
  }

  const HeightGrid& grid_;
  double inverse_cell_, steepest_;
  Eigen::Vector2d lean_ = Eigen::Vector2d::Zero();
  HeightGrid::Cursor cursor_;
  std::vector<VoxelIndex> next_;
};

/// Cells around another one by their distance, up to `radius` cells.
std::vector<VoxelIndex> cells_by_distance(double radius) {
  std::vector<VoxelIndex> cells;
  const int reach = static_cast<int>(radius);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (x * x + y * y <= radius * radius) cells.emplace_back(x, y, 0);
    }
  }
  std::stable_sort(cells.begin(), cells.end(), [](const VoxelIndex& a, const VoxelIndex& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
  return cells;
}

/// Searches from the nearest passable cells around a start (sorted by distance).
void go_from_nearest(const VoxelIndex& start, const std::vector<VoxelIndex>& around, Way& way,
                     HeightGrid& reached) {
  int nearest = -1;
  for (const VoxelIndex& offset : around) {
    if (nearest >= 0 && offset.squaredNorm() > nearest) return;
    if (!way.is_passable(start + offset)) continue;
    nearest = offset.squaredNorm();
    way.go_from(start + offset, reached);
  }
}

/// The gradient of the ground around a start: the medians of the gradients of cells with a height.
/// Zero if there are none.
Eigen::Vector2d lean_around(const VoxelIndex& start, const std::vector<VoxelIndex>& around,
                            Way& way) {
  std::vector<double> along_x, along_y;
  for (const VoxelIndex& offset : around) {
    if (std::isnan(way.height(start + offset))) continue;
    const Eigen::Vector2d gradient = way.gradient(start + offset);
    along_x.push_back(gradient.x());
    along_y.push_back(gradient.y());
  }
  if (along_x.empty()) return Eigen::Vector2d::Zero();
  return {middle_value(along_x), middle_value(along_y)};
}

}  // namespace

HeightGrid reachable(const HeightGrid& grid, const std::vector<VoxelIndex>& starts, double cell,
                     double slope, double start_radius) {
  HeightGrid reached(kNoHeight);
  Way way(grid, cell, slope);
  const std::vector<VoxelIndex> around = cells_by_distance(start_radius);
  for (const VoxelIndex& start : starts) {
    if (way.is_passable(start)) {
      way.go_from(start, reached);
      continue;
    }
    if (!(start_radius > 0.0)) continue;
    // Passable cells do not exclude a hill: at an edge of the ground some cells seem level.
    const Eigen::Vector2d lean = lean_around(start, around, way);
    if (way.is_too_steep(lean)) way.set_lean(lean);
    go_from_nearest(start, around, way, reached);
    way.set_lean(Eigen::Vector2d::Zero());
  }
  return reached;
}

HeightGrid smoothed(const HeightGrid& grid, int threads) {
  HeightGrid result = grid;
  parallel_for(threads, grid.block_count(), 1, [&](std::size_t block) {
    HeightGrid::Cursor cursor;
    const VoxelIndex corner = grid.block_index(static_cast<std::uint32_t>(block)) * kTileSide;
    std::vector<double> around;
    for (std::size_t i = 0; i < HeightGrid::kCells; ++i) {
      double& height = result.at(block * HeightGrid::kCells + i);
      if (std::isnan(height)) continue;
      const int at = static_cast<int>(i);
      const VoxelIndex cell = corner + VoxelIndex(at % kTileSide, at / kTileSide, 0);
      around.clear();
      for (int k = 0; k < 9; ++k) {
        const double other = grid.get(cell + VoxelIndex(k % 3 - 1, k / 3 - 1, 0), cursor);
        if (!std::isnan(other)) around.push_back(other);
      }
      height = median_in_place(around);
    }
  });
  return result;
}

Terrain::Terrain(const Parameters& parameters)
    : parameters_(parameters), inverse_cell_(1.0 / parameters.terrain_cell) {}

void Terrain::add(const Scan& scan, const Mask& ground) {
  if (scan.points.empty()) return;
  const VoxelIndex below = terrain_cell(scan.T_world_sensor.translation(), inverse_cell_);
  if (below_sensors_.empty() || below_sensors_.back() != below) below_sensors_.push_back(below);
  StatisticsGrid::Cursor cursor;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (ground[i] == 0) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
    Statistics& cell = statistics_.make(terrain_cell(world, inverse_cell_), cursor);
    cell.count += 1.0;
    const double from_mean = world.z() - cell.mean;
    cell.mean += from_mean / cell.count;
    cell.squares += from_mean * (world.z() - cell.mean);
  }
}

HeightGrid Terrain::measured() const {
  HeightGrid grid(kNoHeight);
  HeightGrid::Cursor cursor;
  for (std::uint32_t block = 0; block < statistics_.block_count(); ++block) {
    double* const heights = &grid.make(statistics_.block_index(block) * kTileSide, cursor);
    const Statistics* const cells = statistics_.cells(block);
    for (std::size_t i = 0; i < HeightGrid::kCells; ++i) {
      const Statistics& cell = cells[i];
      if (cell.count < parameters_.terrain_points) continue;
      if (cell.squares / cell.count < parameters_.terrain_variance) heights[i] = cell.mean;
    }
  }
  return grid;
}

void Terrain::finish(const RunContext& context) {
  const StageScope timed(context.times, "terrain");
  const Parameters& p = parameters_;
  context.check_cancelled();
  heights_ = measured();
  statistics_ = StatisticsGrid{Statistics{}};
  const Fill first{p.fill_radius * inverse_cell_, p.fill_deviation, p.fill_cells};
  heights_ = filled(heights_, first, context.threads);
  context.check_cancelled();
  heights_ = reachable(heights_, below_sensors_, p.terrain_cell, p.terrain_slope * kDegree,
                       p.start_radius * inverse_cell_);
  const Fill second{p.refill_radius * inverse_cell_, p.refill_deviation, p.fill_cells};
  context.check_cancelled();
  heights_ = smoothed(filled(heights_, second, context.threads), context.threads);
}

}  // namespace raymoval::mapcleaner_method
