// SPDX-License-Identifier: MIT
#include "methods/beautymap/column_map.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace raymoval::beautymap_method {
namespace {

// Constants of the public program.
constexpr double kFinestPart = 0.1;         ///< Height of a part of a slice, metres.
constexpr double kOutlierShare = 0.6;       ///< Of the neighbours that must have points.
constexpr double kOutlierDeviations = 3.0;  ///< From the neighbours' median to an outlier.

int part_count(double slice_height, double part_height) {
  // 31 parts of a 31st must not become 32 by rounding.
  return std::clamp(static_cast<int>(std::ceil(slice_height / part_height - 1e-9)), 1, kMostParts);
}

void take_lower(VoxelKey column, double z, LowestPoints& lowest) {
  const auto [found, is_new] = lowest.try_emplace(column, z);
  if (!is_new && z < found->second) found.value() = z;
}

}  // namespace

Lattice::Lattice(const Parameters& parameters)
    : column_size(parameters.column_size),
      slice_height(parameters.slice_height),
      part_height(std::max(kFinestPart, parameters.slice_height / kMostParts)),
      parts(part_count(slice_height, part_height)) {}

void add_lowest(const LowestPoints& of_scan, LowestPoints& lowest) {
  for (const auto& [column, z] : of_scan) take_lower(column, z, lowest);
}

LowestPoints lowest_points(const Scan& scan, const Lattice& lattice) {
  LowestPoints lowest;
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
    take_lower(column_key(lattice.column_of(world)), world.z(), lowest);
  }
  return lowest;
}

ColumnMap::ColumnMap(const Parameters& parameters, const Lattice& lattice,
                     const LowestPoints& lowest)
    : parameters_(parameters), lattice_(lattice) {
  columns_.reserve(lowest.size());
  for (const auto& [key, z] : lowest) {
    const VoxelIndex cell = voxel_index(key);
    columns_.push_back(
        {.index = {cell.x(), cell.y()}, .foot = z, .points = {}, .removed_parts = {}});
  }
  std::sort(columns_.begin(), columns_.end(),
            [](const Column& a, const Column& b) { return a.index < b.index; });
  numbers_.reserve(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    numbers_[column_key(columns_[i].index)] = static_cast<std::uint32_t>(i);
    lowest_ = i == 0 ? columns_[i].foot : std::min(lowest_, columns_[i].foot);
  }
  place_feet(lowest);
}

std::vector<double> ColumnMap::lowest_around(const Column& column,
                                             const LowestPoints& lowest) const {
  const int end = parameters_.public_outliers ? -1 : kOutlierReach;
  std::vector<double> around;
  for (int dx = -kOutlierReach; dx <= end; ++dx) {
    for (int dy = -kOutlierReach; dy <= end; ++dy) {
      if (dx == 0 && dy == 0) continue;
      const ColumnIndex neighbour{column.index.x + dx, column.index.y + dy};
      if (parameters_.public_outliers) {
        const std::uint32_t number = find(neighbour);
        if (number != kNone) around.push_back(columns_[number].foot);
      } else if (const auto found = lowest.find(column_key(neighbour)); found != lowest.end()) {
        around.push_back(found->second);
      }
    }
  }
  return around;
}

void ColumnMap::place_feet(const LowestPoints& lowest) {
  const int side = parameters_.public_outliers ? kOutlierReach : 2 * kOutlierReach + 1;
  const int all = side * side - (parameters_.public_outliers ? 0 : 1);
  for (Column& column : columns_) {  // In order, because moved feet are neighbours too.
    std::vector<double> around = lowest_around(column, lowest);
    if (static_cast<double>(around.size()) < kOutlierShare * all) continue;
    const double middle = middle_value(around);
    for (double& z : around) z = std::abs(z - middle);
    const double reachable = kOutlierDeviations * middle_value(around);
    const double foot = std::clamp(column.foot, middle - reachable, middle + reachable);
    column.is_outlier = foot != column.foot;
    column.foot = foot;
  }
}

void ColumnMap::place(const Scan& scan, std::vector<PlacedPoint>& placed) const {
  placed.resize(scan.size());
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
    PlacedPoint& point = placed[k];
    point.column = find(lattice_.column_of(world));
    const double above_foot = world.z() - columns_[point.column].foot;
    const int slice = lattice_.slice_of(above_foot);
    point.slice = static_cast<std::int16_t>(slice);
    point.part = static_cast<std::int16_t>(slice < 0 ? -1 : lattice_.part_of(above_foot, slice));
  }
}

void ColumnMap::add(const std::vector<PlacedPoint>& placed) {
  const auto parts = static_cast<std::size_t>(lattice_.parts);
  for (const PlacedPoint& point : placed) {
    if (point.slice < 0) continue;
    std::vector<std::uint32_t>& points = columns_[point.column].points;
    const std::size_t first = static_cast<std::size_t>(point.slice) * parts;
    if (points.size() < first + parts) points.resize(first + parts);
    // A point less than one slice below the foot counts in the first part of slice 0.
    ++points[first + static_cast<std::size_t>(std::max<int>(point.part, 0))];
  }
}

bool ColumnMap::holds_points(const Column& column, int slice) const {
  const auto parts = static_cast<std::ptrdiff_t>(lattice_.parts);
  const auto first = column.points.begin() + slice * parts;
  return std::any_of(first, first + parts, [](std::uint32_t points) { return points > 0; });
}

void ColumnMap::finish() {
  for (Column& column : columns_) {
    const int slices = static_cast<int>(column.points.size()) / lattice_.parts;
    int empty = 0;
    for (int slice = 0; slice < slices; ++slice) {
      if (!holds_points(column, slice)) {
        // Points above a gap of two slices do not belong to a column: crowns of trees, bridges.
        if (++empty >= 2 && column.last_slice >= 0) break;
        continue;
      }
      empty = 0;
      column.last_slice = slice;
      column.occupied |= std::uint32_t{1} << std::min(slice, kTopSlice);
    }
  }
}

bool ColumnMap::is_removed(const PlacedPoint& point) const {
  const Column& column = columns_[point.column];
  if (point.slice < 0 || point.slice > column.last_slice) return false;
  const int slice = std::min<int>(point.slice, kTopSlice);
  if ((column.removed >> slice & 1) != 0) {
    const bool is_forgotten =
        parameters_.public_top && point.slice >= kTopSlice && point.slice != column.last_slice;
    return !is_forgotten;
  }
  const auto at = static_cast<std::size_t>(slice);
  return point.part >= 0 && slice < kTopSlice && at < column.removed_parts.size() &&
         (column.removed_parts[at] >> point.part & 1) != 0;
}

}  // namespace raymoval::beautymap_method
