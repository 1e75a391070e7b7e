// SPDX-License-Identifier: MIT
#include "methods/beautymap/scan_window.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/sampling.h"

namespace raymoval::beautymap_method {

ScanWindow::ScanWindow(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
                       const std::vector<PlacedPoint>& placed)
    : map_(map), sensor_(scan.T_world_sensor.translation()) {
  place(parameters);
  find_columns();
  enter(parameters, placed);
  find_steepest(scan);
  const bool is_known = at(center_, center_).column != ColumnMap::kNone;
  center_foot_ =
      parameters.public_lattice || is_known ? foot(center_, center_) : foot_around(parameters);
}

void ScanWindow::place(const Parameters& parameters) {
  const Lattice& lattice = map_.lattice();
  center_ = static_cast<int>(parameters.window_side / lattice.column_size) / 2;
  if (!parameters.public_lattice) {
    const ColumnIndex own = lattice.column_of(sensor_);
    first_ = {own.x - center_, own.y - center_};
    side_ = 2 * center_ + 1;
    return;
  }
  // B.1: cut off to whole metres, then to columns.
  side_ = static_cast<int>(parameters.window_side / lattice.column_size);
  const auto first = [&](double position) {
    const double meters = std::trunc(position) - center_ * lattice.column_size;
    return static_cast<int>(meters / lattice.column_size);
  };
  first_ = {first(sensor_.x() - lattice.origin.x()), first(sensor_.y() - lattice.origin.y())};
}

void ScanWindow::find_columns() {
  cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
  for (int x = 0; x < side_; ++x) {
    for (int y = 0; y < side_; ++y) {
      cells_[number(x, y)].column = map_.find({first_.x + x, first_.y + y});
    }
  }
}

void ScanWindow::enter(const Parameters& parameters, const std::vector<PlacedPoint>& placed) {
  for (const PlacedPoint& point : placed) {
    const ColumnIndex& column = map_.columns()[point.column].index;
    const int x = column.x - first_.x, y = column.y - first_.y;
    if (x < 0 || y < 0 || x >= side_ || y >= side_) continue;
    Cell& cell = cells_[number(x, y)];
    is_empty_ = false;
    cell.has_higher |= point.slice > kTopSlice;
    cell.has_lower |= point.slice <= kTopSlice;
    if (point.slice >= 0 && point.slice <= kTopSlice) cell.seen |= std::uint32_t{1} << point.slice;
  }
  for (Cell& cell : cells_) {
    if (cell.has_higher && (cell.has_lower || !parameters.public_top)) {
      cell.seen |= std::uint32_t{1} << kTopSlice;
    }
  }
}

void ScanWindow::find_steepest(const Scan& scan) {
  steepest_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& point : scan.points) {
    // The direction in the world's axes, since the sensor may be tilted.
    const Eigen::Vector3d ray = scan.T_world_sensor.linear() * point.cast<double>();
    const double way = ray.head<2>().norm();
    if (way > 0.0) steepest_ = std::max(steepest_, ray.z() / way);
  }
}

double ScanWindow::foot(int x, int y) const {
  const std::uint32_t column = at(x, y).column;
  return column == ColumnMap::kNone ? map_.lowest() : map_.columns()[column].foot;
}

double ScanWindow::foot_around(const Parameters& parameters) const {
  const int reach = std::min(std::max(parameters.outlier_neighbours, 1), center_);
  std::vector<double> feet;
  for (int x = center_ - reach; x <= center_ + reach; ++x) {
    for (int y = center_ - reach; y <= center_ + reach; ++y) {
      if (at(x, y).column != ColumnMap::kNone) feet.push_back(foot(x, y));
    }
  }
  return feet.empty() ? map_.lowest() : median(std::move(feet));
}

}  // namespace raymoval::beautymap_method
