// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/simd/simd.h"
#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/occupancy_map.h"

namespace raymoval::raymoval_method::sweep {

/// Boxes are expanded in groups of this size, for any vector width.
inline constexpr std::size_t kGroup = 16;

/// Tables that depend only on the grid of directions.
struct GridTables {
  int columns = 0, rows = 0;
  int padded_rows = 0;  ///< Rows rounded up to a multiple of kGroup.
  float elevation_min = 0.0F, inverse_elevation_step = 0.0F, inverse_azimuth_step = 0.0F;
  std::vector<double> azimuth_cosine, azimuth_sine;      ///< At the columns' centres.
  std::vector<double> elevation_cosine, elevation_sine;  ///< At the rows' centres.
  /// Tangents a little below and above each row's centre; infinite beyond the vertical.
  std::vector<float> tangent_below, tangent_above;
};

/// Voxel walls around a sensor: `wall(k, c)` of lattice plane c along axis k.
class WallTables {
 public:
  void build(const OccupancyMap& map, const Eigen::Vector3d& position, double range) {
    constexpr int kMargin = 2 * OccupancyMap::kBrickSide;
    const VoxelIndex cell = map.voxel_of(position);
    const int reach = static_cast<int>(std::ceil(range * map.inverse_voxel_size())) + 1;
    for (int k = 0; k < 3; ++k) {
      low_[k] = cell[k] - reach;
      high_[k] = cell[k] + reach;
      first_[k] = low_[k] - kMargin;
      auto& walls = walls_[static_cast<std::size_t>(k)];
      walls.resize(static_cast<std::size_t>(2 * (reach + kMargin) + 1));
      for (std::size_t i = 0; i < walls.size(); ++i) {
        const int plane = first_[k] + static_cast<int>(i);
        walls[i] = static_cast<float>(plane * map.voxel_size() - position[k]);
      }
    }
  }
  [[nodiscard]] const float* data(std::size_t axis) const { return walls_[axis].data(); }
  /// First and last voxel within the range.
  [[nodiscard]] const Eigen::Vector3i& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3i& high() const { return high_; }
  /// The index of the first wall of a brick; the brick has a voxel within low .. high.
  [[nodiscard]] std::int32_t brick_offset(Eigen::Index axis, std::int32_t brick) const {
    return brick * OccupancyMap::kBrickSide - first_[axis];
  }

 private:
  std::array<std::vector<float>, 3> walls_;
  Eigen::Vector3i low_, high_, first_;
};

/// Bricks within reach of the sensor, one array per property, padded to a multiple of kGroup.
struct BrickList {
  std::size_t count = 0;
  std::array<AlignedArray<float>, 3> low, high;  ///< Tight box from the sensor, world axes, metres.
  std::array<AlignedArray<std::int32_t>, 3> plane;  ///< Index of the brick's walls in the tables.
  AlignedArray<OccupancyMap::Slot> slot;
  // Found by measure_bricks; a brick in no column has first_column > last_column.
  AlignedArray<float> nearest;  ///< No ray enters it nearer than this.
  AlignedArray<std::int32_t> first_column,
      last_column;  ///< May be below 0 or beyond the last column.
  AlignedArray<std::int32_t> first_row, last_row;

  void require(std::size_t bricks);
};

/// One image's inputs.
struct Frame {
  const OccupancyMap* map = nullptr;
  const GridTables* grid = nullptr;
  const WantedBins* wanted = nullptr;
  BrickList* bricks = nullptr;
  std::vector<std::uint32_t>* order = nullptr;  ///< The visible bricks, nearest first.
  /// World coordinates of the sensor's axes.
  std::array<double, 3> x_axis{}, y_axis{}, up{};
  std::array<int, 2> level_axes{};       ///< The two world axes that are the least upright.
  std::array<const float*, 3> planes{};  ///< Voxel walls along each axis from the sensor, metres.
  float minimum_range = 0.0F, maximum_range = 0.0F;
  float slack = 0.0F;        ///< Bounds are widened by this, metres.
  std::uint64_t number = 0;  ///< The number of the image among those of its caster, from 1.
};

/// A brick in the list of a column.
struct ColumnEntry {
  std::uint32_t brick;
  std::uint16_t first_row, last_row;
  float nearest;
};

/// Bricks seen in the columns begin .. end - 1, nearest first.
struct ColumnLists {
  int begin = 0, end = 0;
  std::vector<std::uint32_t> starts;  ///< First entry of each column, and the end of the last.
  std::vector<ColumnEntry> entries;
};

/// Memory of one thread's sweep, kept between images.
struct Scratch {
  std::uint64_t frame = 0;  ///< The image it is prepared for.
  /// The expanded boxes of a brick: place and number.
  struct Expanded {
    std::uint32_t begin = 0;
    std::uint32_t boxes = 0;
    bool done = false;
  };
  std::vector<Expanded> expanded;
  AlignedArray<float> boxes;
  std::size_t boxes_used = 0;
  AlignedArray<float> pieces;  ///< Boxes of one brick, cut at the sensor's planes.
  AlignedArray<float> bounds;  ///< The bounds of one brick's boxes in one column.
  std::vector<std::uint32_t> crossing;
  // One column's lines, which are its wanted rows.
  AlignedArray<std::int32_t> row;     ///< The row of each line.
  std::vector<std::uint32_t> before;  ///< Lines before each word of the column's wanted bins.
  AlignedArray<float> directions;     ///< Inverse directions.
  AlignedArray<float> depth;          ///< Ranges.
};

/// Fills the measured properties of `BrickList` for the bricks begin .. end - 1. `begin` and `end`
/// are multiples of kGroup; `end` may also be the end of the list.
void measure_bricks(const Frame& frame, std::size_t begin, std::size_t end);

/// Writes the wanted first hits of columns begin .. end - 1, which are all in `lists`, to `range`
/// (row by row, all columns).
void sweep_columns(const Frame& frame, const ColumnLists& lists, int begin, int end,
                   Scratch& scratch, float* range);

}  // namespace raymoval::raymoval_method::sweep
