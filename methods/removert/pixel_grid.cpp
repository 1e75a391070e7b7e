// SPDX-License-Identifier: MIT
// Compiled without errno and trap handling of the square root (see CMakeLists.txt), so that
// the loop of `PointBatch::project` is vectorised.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/common/single_angles.h"
#include "methods/removert/scan_image.h"

namespace raymoval::removert_method {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Uncertainty in pixels at one pixel per degree: ten times the error of single precision.
constexpr double kMargin = 1e-3;

}  // namespace

PixelGrid::PixelGrid(const Parameters& parameters, double resolution)
    : rows_(std::max(1, static_cast<int>(std::lround(parameters.vertical_fov * resolution)))),
      columns_(std::max(1, static_cast<int>(std::lround(parameters.horizontal_fov * resolution)))),
      row_scale_(rows_ / (parameters.vertical_fov * kRadiansPerDegree)),
      column_scale_(columns_ / (parameters.horizontal_fov * kRadiansPerDegree)),
      clamp_(parameters.clamp_fov),
      wrap_(parameters.wrap_azimuth && parameters.horizontal_fov == 360.0),
      full_circle_(parameters.horizontal_fov == 360.0),
      margin_(static_cast<float>(std::min(0.4, kMargin * std::max(1.0, resolution)))) {}

int PixelGrid::pixel_of(const Eigen::Vector3d& point) const {
  const double row = raw_row(std::atan2(point.z(), std::hypot(point.x(), point.y())));
  const double column = raw_column(std::atan2(point.y(), point.x()));
  // std::lround would round halves away from zero. The two differ only below zero, where values are
  // clamped or outside.
  return pixel_from(row, column, static_cast<int>(std::floor(row + 0.5)),
                    static_cast<int>(std::floor(column + 0.5)));
}

void PointBatch::project(const PixelGrid& grid, int count) {
  const float row_middle = static_cast<float>(0.5 * grid.rows());
  const float column_middle = static_cast<float>(0.5 * grid.columns());
  const float row_scale = static_cast<float>(grid.row_scale());
  const float column_scale = static_cast<float>(grid.column_scale());
  for (int i = 0; i < count; ++i) {
    const float flat_square = x[i] * x[i] + y[i] * y[i];
    const float flat = std::sqrt(flat_square);
    const float length = std::sqrt(flat_square + z[i] * z[i]);
    const float azimuth = single_azimuth(x[i], y[i]);
    const float elevation = single_elevation(flat, z[i]);
    const float exact_row = row_middle - elevation * row_scale;
    row[i] = flat > 0.02F * (length + 1.0F) ? exact_row : 2.0F * PixelGrid::kNearAxis;
    column[i] = column_middle + azimuth * column_scale;
    range[i] = length;
  }
}

}  // namespace raymoval::removert_method
