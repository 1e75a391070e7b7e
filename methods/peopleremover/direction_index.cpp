// SPDX-License-Identifier: MIT
#include "methods/peopleremover/direction_index.h"

#include <algorithm>
#include <cmath>

#include "methods/common/diamond_angle.h"

namespace raymoval::peopleremover_method {
namespace {

int row_of(double sine) {
  return std::clamp(static_cast<int>((sine + 1.0) * (DirectionIndex::kRows / 2.0)), 0,
                    DirectionIndex::kRows - 1);
}

int column_of(double x, double y) {
  return std::clamp(static_cast<int>(diamond_angle(x, y) * (DirectionIndex::kColumns / 4.0)), 0,
                    DirectionIndex::kColumns - 1);
}

}  // namespace

void DirectionIndex::build(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t count = points.size();
  cell_start_.assign(static_cast<std::size_t>(kRows * kColumns) + 1, 0);
  cell_of_.resize(count);
  range_of_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    range_of_[k] = points[k].norm();
    const int row = row_of(points[k].z() / range_of_[k]);
    cell_of_[k] =
        static_cast<std::uint32_t>(row * kColumns + column_of(points[k].x(), points[k].y()));
    ++cell_start_[cell_of_[k] + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  number.resize(count);
  range.resize(count);
  direction.resize(count);
  point.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = cell_start_[cell_of_[k]]++;
    number[at] = static_cast<std::uint32_t>(k);
    range[at] = range_of_[k];
    direction[at] = points[k] / range_of_[k];
    point[at] = points[k];
  }
  // Filling moved every start to the next cell's.
  for (std::size_t c = cell_start_.size() - 1; c > 0; --c) cell_start_[c] = cell_start_[c - 1];
  cell_start_[0] = 0;
}

DirectionIndex::Window DirectionIndex::window_around(const Eigen::Vector3d& u, double half_sine) {
  // Far above rounding, far below a cell.
  constexpr double kMargin = 2e-9;
  const double cosine = 1.0 - 2.0 * half_sine * half_sine - 0.5 * kMargin;
  const double sine = 2.0 * half_sine * std::sqrt(std::max(0.0, 1.0 - half_sine * half_sine));
  const double flat = std::sqrt(u.x() * u.x() + u.y() * u.y());
  const bool has_top = u.z() >= cosine, has_bottom = -u.z() >= cosine;
  Window window{};
  window.last_row = has_top ? kRows - 1 : row_of(u.z() * cosine + flat * sine + kMargin);
  window.first_row = has_bottom ? 0 : row_of(u.z() * cosine - flat * sine - kMargin);
  if (has_top || has_bottom || flat <= sine * (1.0 + kMargin)) {
    window.last_column = kColumns - 1;
    return window;
  }
  // Half width of the cap in azimuth: sin = sin(angle) / cos(elevation).
  const double s = std::min(1.0, sine / flat + kMargin);
  const double c = std::sqrt(1.0 - s * s);
  window.first_column = column_of(u.x() * c + u.y() * s, u.y() * c - u.x() * s);
  window.last_column = column_of(u.x() * c - u.y() * s, u.y() * c + u.x() * s);
  if (window.last_column < window.first_column) window.last_column += kColumns;
  return window;
}

}  // namespace raymoval::peopleremover_method
