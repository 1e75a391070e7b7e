// SPDX-License-Identifier: MIT
#include "methods/raymoval/angular_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raymoval {

using std::numbers::pi;

Spherical to_spherical(const Eigen::Vector3d& point) {
  const double range = point.norm();
  if (range == 0.0) return {0.0, 0.0, 0.0};
  return {range, std::atan2(point.y(), point.x()),
          std::asin(std::clamp(point.z() / range, -1.0, 1.0))};
}

double AngularGrid::azimuth_step() const {
  return 2.0 * pi / azimuth_bins;
}

double AngularGrid::elevation_step() const {
  return (elevation_max - elevation_min) / elevation_bins;
}

std::optional<int> AngularGrid::bin_of(double azimuth, double elevation) const {
  const double j = std::floor((elevation - elevation_min) / elevation_step());
  if (!(j >= 0.0 && j < elevation_bins)) return std::nullopt;
  // The azimuth pi is the azimuth -pi.
  const int i = static_cast<int>(std::floor((azimuth + pi) / azimuth_step()));
  return static_cast<int>(j) * azimuth_bins + (i >= azimuth_bins ? 0 : std::max(i, 0));
}

double AngularGrid::azimuth_centre(int i) const {
  return -pi + (i + 0.5) * azimuth_step();
}

double AngularGrid::elevation_centre(int j) const {
  return elevation_min + (j + 0.5) * elevation_step();
}

Eigen::Vector3d AngularGrid::direction(int bin) const {
  const double azimuth = azimuth_centre(azimuth_of(bin));
  const double elevation = elevation_centre(elevation_of(bin));
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
          std::sin(elevation)};
}

DirectionTable::DirectionTable(const AngularGrid& grid) {
  for (int i = 0; i < grid.azimuth_bins; ++i) {
    const double azimuth = grid.azimuth_centre(i);
    azimuth_.emplace_back(std::cos(azimuth), std::sin(azimuth));
  }
  for (int j = 0; j < grid.elevation_bins; ++j) {
    const double elevation = grid.elevation_centre(j);
    elevation_.emplace_back(std::cos(elevation), std::sin(elevation));
  }
}

ProjectedScan project(const Scan& scan, const AngularGrid& grid, double minimum_range) {
  ProjectedScan projected;
  projected.range.resize(scan.size());
  projected.bin.assign(scan.size(), -1);
  projected.minimum_range.assign(static_cast<std::size_t>(grid.size()), kNoRange);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Spherical at = to_spherical(scan.points[k].cast<double>());
    projected.range[k] = static_cast<float>(at.range);
    if (at.range < minimum_range) continue;
    const std::optional<int> bin = grid.bin_of(at.azimuth, at.elevation);
    if (!bin) continue;
    projected.bin[k] = *bin;
    float& nearest = projected.minimum_range[static_cast<std::size_t>(*bin)];
    nearest = std::min(nearest, projected.range[k]);
  }
  return projected;
}

}  // namespace raymoval
