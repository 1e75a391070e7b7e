// SPDX-License-Identifier: MIT
// Compiled without errno and trap handling of the square root (see CMakeLists.txt), so that
// the loop of `PointBatch::project` is vectorised.
#include "methods/removert/pixel_grid.h"

#include <numbers>

namespace raymoval::removert_method {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Pixels of doubt at one pixel per degree: ten times what single precision can be wrong.
constexpr double kMargin = 1e-3;

/// Arc tangent of 0 <= t <= 1 in radians, wrong by 2e-8 at most before rounding (Abramowitz and
/// Stegun, 4.4.49).
inline float arc_tangent(float t) {
  const float s = t * t;
  float sum = 0.0028662257F;
  sum = sum * s - 0.0161657367F;
  sum = sum * s + 0.0429096138F;
  sum = sum * s - 0.0752896400F;
  sum = sum * s + 0.1065626393F;
  sum = sum * s - 0.1420889944F;
  sum = sum * s + 0.1999355085F;
  sum = sum * s - 0.3333314528F;
  return t + t * s * sum;
}

/// Angle of (a, b) for a, b >= 0, from the axis of a towards that of b.
inline float angle_in_quadrant(float a, float b) {
  const float larger = a > b ? a : b, smaller = a > b ? b : a;
  const float angle = arc_tangent(smaller / (larger + 1e-30F));
  return a > b ? angle : static_cast<float>(std::numbers::pi / 2.0) - angle;
}

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
  // std::lround would round halves away from zero; the two differ below zero only, and what lies
  // there is clamped or outside.
  return pixel_from(row, column, static_cast<int>(std::floor(row + 0.5)),
                    static_cast<int>(std::floor(column + 0.5)));
}

void PointBatch::project(const PixelGrid& grid, int count) {
  const float row_middle = static_cast<float>(0.5 * grid.rows());
  const float column_middle = static_cast<float>(0.5 * grid.columns());
  const float row_scale = static_cast<float>(grid.row_scale());
  const float column_scale = static_cast<float>(grid.column_scale());
  constexpr float kPi = static_cast<float>(std::numbers::pi);
  for (int i = 0; i < count; ++i) {
    const float flat_square = x[i] * x[i] + y[i] * y[i];
    const float flat = std::sqrt(flat_square);
    const float length = std::sqrt(flat_square + z[i] * z[i]);
    const float quadrant = angle_in_quadrant(std::abs(x[i]), std::abs(y[i]));
    const float half = x[i] < 0.0F ? kPi - quadrant : quadrant;
    const float azimuth = y[i] < 0.0F ? -half : half;
    const float steep = angle_in_quadrant(flat, std::abs(z[i]));
    const float elevation = z[i] < 0.0F ? -steep : steep;
    const float exact_row = row_middle - elevation * row_scale;
    row[i] = flat > 0.02F * (length + 1.0F) ? exact_row : 2.0F * PixelGrid::kNearAxis;
    column[i] = column_middle + azimuth * column_scale;
    range[i] = length;
  }
}

}  // namespace raymoval::removert_method
