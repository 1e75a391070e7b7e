// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/first_hit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"

namespace raymoval::raymoval_method {
namespace {

using sweep::BrickList;
using sweep::ColumnEntry;
using sweep::ColumnLists;
using sweep::Frame;
using sweep::GridTables;
using sweep::kGroup;
using sweep::WallTables;

constexpr double kSteep = 1.55;  // Beyond this elevation the tangent counts as infinite.

GridTables tables_for(const AngularGrid& grid) {
  GridTables tables;
  tables.columns = grid.azimuth_bins;
  tables.rows = grid.elevation_bins;
  const auto group = static_cast<int>(kGroup);
  tables.padded_rows = (grid.elevation_bins + group - 1) / group * group;
  tables.elevation_min = static_cast<float>(grid.elevation_min);
  tables.inverse_elevation_step = static_cast<float>(1.0 / grid.elevation_step());
  tables.inverse_azimuth_step = static_cast<float>(1.0 / grid.azimuth_step());
  for (int i = 0; i < grid.azimuth_bins; ++i) {
    tables.azimuth_cosine.push_back(std::cos(grid.azimuth_centre(i)));
    tables.azimuth_sine.push_back(std::sin(grid.azimuth_centre(i)));
  }
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const double margin = 0.05 * grid.elevation_step();
  for (int j = 0; j < tables.padded_rows; ++j) {
    const double elevation = grid.elevation_centre(std::min(j, grid.elevation_bins - 1));
    tables.elevation_cosine.push_back(std::cos(elevation));
    tables.elevation_sine.push_back(std::sin(elevation));
    const double below = elevation - margin, above = elevation + margin;
    tables.tangent_below.push_back(
        below < -kSteep ? -kInfinite : static_cast<float>(std::tan(std::min(below, kSteep))));
    tables.tangent_above.push_back(
        above > kSteep ? kInfinite : static_cast<float>(std::tan(std::max(above, -kSteep))));
  }
  return tables;
}

/// Adds the tile's bricks that are within range.
void gather_tile(std::span<const OccupancyMap::BrickHead> heads, const WallTables& walls,
                 float range, BrickList& bricks) {
  bricks.require(bricks.count + heads.size());
  const Eigen::Vector3i low = OccupancyMap::brick_of(walls.low());
  const Eigen::Vector3i high = OccupancyMap::brick_of(walls.high());
  for (const OccupancyMap::BrickHead& head : heads) {
    if (head.is_empty) continue;
    const std::size_t i = bricks.count;
    float squared = 0.0F;
    bool within = true;
    for (std::size_t k = 0; k < 3 && within; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      within = head.at[k] >= low[axis] && head.at[k] <= high[axis];
      if (!within) break;
      const std::int32_t offset = walls.brick_offset(axis, head.at[k]);
      const float* wall = walls.data(k) + offset;
      const float near = wall[head.bounds.first(k)], far = wall[head.bounds.last(k) + 1];
      const float gap = std::max({near, -far, 0.0F});
      squared += gap * gap;
      bricks.low[k][i] = near;
      bricks.high[k][i] = far;
      bricks.plane[k][i] = offset;
    }
    if (!within || squared > range * range) continue;
    bricks.slot[i] = head.slot;
    ++bricks.count;
  }
}

void gather_bricks(const OccupancyMap& map, const WallTables& walls, float range,
                   BrickList& bricks) {
  bricks.count = 0;
  const Eigen::Vector2i low = OccupancyMap::tile_of(OccupancyMap::brick_of(walls.low()));
  const Eigen::Vector2i high = OccupancyMap::tile_of(OccupancyMap::brick_of(walls.high()));
  const std::int64_t within = std::int64_t{high.x() - low.x() + 1} * (high.y() - low.y() + 1);
  if (within > static_cast<std::int64_t>(map.tile_count())) {
    for (std::size_t i = 0; i < map.tile_count(); ++i) {
      gather_tile(map.tile(i), walls, range, bricks);
    }
  } else {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        gather_tile(map.tile(x, y), walls, range, bricks);
      }
    }
  }
  // The padding is measured too, so it must hold valid numbers.
  bricks.require(bricks.count);
  for (std::size_t i = bricks.count; i % kGroup != 0; ++i) {
    for (std::size_t k = 0; k < 3; ++k) bricks.low[k][i] = bricks.high[k][i] = 1.0F;
  }
}

/// Front to back, in steps of 1/8 m: the depth test then closes most rows early.
void sort_by_distance(const BrickList& bricks, std::vector<std::uint32_t>& starts,
                      std::vector<std::uint32_t>& order) {
  constexpr float kStepsPerMetre = 8.0F;
  const auto is_seen = [&](std::size_t i) {
    return bricks.first_column[i] <= bricks.last_column[i];
  };
  const auto step_of = [&](std::size_t i) {
    return static_cast<std::size_t>(bricks.nearest[i] * kStepsPerMetre) + 1;
  };
  starts.clear();
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < bricks.count; ++i) {
    if (!is_seen(i)) continue;
    if (starts.size() <= step_of(i)) starts.resize(step_of(i) + 1, 0);
    ++starts[step_of(i)];
    ++count;
  }
  order.resize(count);
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  for (std::size_t i = 0; i < bricks.count; ++i) {
    if (is_seen(i)) order[starts[step_of(i) - 1]++] = static_cast<std::uint32_t>(i);
  }
}

/// Calls `visit(column)` for the brick's columns within begin .. end - 1.
template <class Visit>
void for_columns(const Frame& frame, std::size_t brick, int begin, int end, Visit&& visit) {
  const int columns = frame.grid->columns;
  const int first = frame.bricks->first_column[brick], last = frame.bricks->last_column[brick];
  if (first >= begin && last < end) {  // The usual case.
    for (int i = first; i <= last; ++i) visit(i - begin);
    return;
  }
  for (int turn = -columns; turn <= columns; turn += columns) {
    const int to = std::min(last + turn, end - 1);
    for (int i = std::max(first + turn, begin); i <= to; ++i) visit(i - begin);
  }
}

/// Sorts the bricks into the columns that see them, nearest first.
void list_columns(const Frame& frame, int begin, int end, ColumnLists& lists) {
  const BrickList& bricks = *frame.bricks;
  auto& starts = lists.starts;
  lists.begin = begin;
  lists.end = end;
  starts.assign(static_cast<std::size_t>(end - begin) + 2, 0);
  for (const std::uint32_t brick : *frame.order) {
    for_columns(frame, brick, begin, end,
                [&](int i) { ++starts[static_cast<std::size_t>(i) + 2]; });
  }
  for (std::size_t i = 2; i < starts.size(); ++i) starts[i] += starts[i - 1];
  if (lists.entries.size() < starts.back()) lists.entries.resize(starts.back());
  for (const std::uint32_t brick : *frame.order) {
    const ColumnEntry entry{brick, static_cast<std::uint16_t>(bricks.first_row[brick]),
                            static_cast<std::uint16_t>(bricks.last_row[brick]),
                            bricks.nearest[brick]};
    for_columns(frame, brick, begin, end,
                [&](int i) { lists.entries[starts[static_cast<std::size_t>(i) + 1]++] = entry; });
  }
}

/// The two world axes farthest from the sensor's up axis.
std::array<int, 2> level_axes(const std::array<double, 3>& up) {
  std::array<int, 3> axes = {0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) {
    return std::abs(up[static_cast<std::size_t>(a)]) < std::abs(up[static_cast<std::size_t>(b)]);
  });
  return {axes[0], axes[1]};
}

}  // namespace

FirstHitCaster::FirstHitCaster(const AngularGrid& grid, const RayLimits& limits)
    : grid_(grid), limits_(limits), tables_(tables_for(grid)) {
  all_.request_all(grid);
}

void FirstHitCaster::cast(OccupancyMap& map, const Pose& T_world_sensor, const WantedBins& wanted,
                          int threads, FirstHitImage& image) {
  map.update_boxes(threads);
  Frame frame = start_frame(map, T_world_sensor);
  frame.wanted = &wanted;
  gather_bricks(map, walls_, frame.maximum_range, bricks_);
  parallel_chunks(threads, bricks_.count, 32 * kGroup, [&](std::size_t begin, std::size_t end) {
    sweep::measure_bricks(frame, begin, end);
  });
  sort_by_distance(bricks_, starts_, order_);
  image.grid = grid_;
  image.T_world_sensor = T_world_sensor;
  image.limits = limits_;
  image.range.resize(static_cast<std::size_t>(grid_.size()));
  sweep_image(frame, threads, image.range.data());
}

Frame FirstHitCaster::start_frame(const OccupancyMap& map, const Pose& T_world_sensor) {
  walls_.build(map, T_world_sensor.translation(), limits_.maximum_range);
  Frame frame;
  frame.map = &map;
  frame.grid = &tables_;
  frame.bricks = &bricks_;
  frame.order = &order_;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    frame.x_axis[k] = T_world_sensor.linear()(axis, 0);
    frame.y_axis[k] = T_world_sensor.linear()(axis, 1);
    frame.up[k] = T_world_sensor.linear()(axis, 2);
    frame.planes[k] = walls_.data(k);
  }
  frame.level_axes = level_axes(frame.up);
  frame.minimum_range = static_cast<float>(limits_.minimum_range);
  frame.maximum_range = static_cast<float>(limits_.maximum_range);
  frame.number = ++images_;
  frame.slack = static_cast<float>(1e-4 + 2e-6 * limits_.maximum_range);
  return frame;
}

/// Each thread lists the bricks of one part of the circle. The parts are then swept in smaller
/// pieces, because pieces take different times.
void FirstHitCaster::sweep_image(const Frame& frame, int threads, float* range) {
  constexpr std::size_t kPiece = kGroup;
  const auto columns = static_cast<std::size_t>(grid_.azimuth_bins);
  const auto parts = static_cast<std::size_t>(std::max(threads, 1));
  const std::size_t width = (columns / parts / kPiece + 1) * kPiece;
  lists_.resize((columns + width - 1) / width);
  parallel_chunks(threads, columns, width, [&](std::size_t begin, std::size_t end) {
    list_columns(frame, static_cast<int>(begin), static_cast<int>(end), lists_[begin / width]);
  });
  const std::size_t piece = threads <= 1 ? width : kPiece;
  parallel_chunks(threads, columns, piece, [&](std::size_t begin, std::size_t end) {
    scratch_.with_one([&](sweep::Scratch& scratch) {
      sweep::sweep_columns(frame, lists_[begin / width], static_cast<int>(begin),
                           static_cast<int>(end), scratch, range);
    });
  });
}

FirstHitImage cast_first_hits(OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, const RayLimits& limits, int threads) {
  FirstHitImage image;
  FirstHitCaster(grid, limits).cast(map, T_world_sensor, threads, image);
  return image;
}

std::optional<VoxelIndex> FirstHitImage::voxel(const OccupancyMap& map, int bin) const {
  const double hit = range[static_cast<std::size_t>(bin)];
  if (!(hit <= limits.maximum_range)) return std::nullopt;
  // The error of float ranges is smaller than this; the ray is empty before it.
  const double rounding = 1e-3 * map.voxel_size() + 1e-6 * hit;
  const auto found = cast_ray(map, ray(bin), limits, std::max(0.0, hit - rounding));
  if (!found) return std::nullopt;
  return found->voxel;
}

}  // namespace raymoval::raymoval_method
