// SPDX-License-Identifier: MIT
#include "methods/freedom/depth_image.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace raymoval::freedom_method {
namespace {

constexpr double kUnitsOfDepth = 255.0;
// The public program's settings for KITTI.
constexpr int kRows = 64;             ///< Of a sensor whose steps are unknown.
constexpr double kNearest = 0.2;      ///< Nearer points are not in the image, metres.
constexpr double kMargin = 0.2;       ///< Gap before the inpainted depth, metres.
constexpr int kInpaintingRadius = 3;  ///< Pixels.
// No current sensor has finer images. This limits the cost of a wrong step.
constexpr double kMostRows = 720.0, kFinestPixel = 0.05 * kDegree;

/// Rows of a sensor's image: one for each step of its beams.
int rows_of(const SensorModel& sensor) {
  if (!(sensor.elevation_step > 0.0)) return kRows;
  const double height = sensor.elevation_max - sensor.elevation_min;
  return static_cast<int>(
      std::clamp(std::round(height / sensor.elevation_step) + 1.0, 2.0, kMostRows));
}

/// The image, extended on either side by columns of its other end.
HoleImage wrapped(const HoleImage& image, int wings) {
  HoleImage wide{image.rows, image.columns + 2 * wings, {}, {}};
  for (int row = 0; row < wide.rows; ++row) {
    for (int column = -wings; column < image.columns + wings; ++column) {
      const auto from =
          static_cast<std::size_t>(row * image.columns + (column + image.columns) % image.columns);
      wide.values.push_back(image.values[from]);
      wide.is_hole.push_back(image.is_hole[from]);
    }
  }
  return wide;
}

/// Fills the holes of an image.
void fill_holes(HoleImage& image, bool is_full_turn) {
  const int wings = is_full_turn ? std::min(kInpaintingRadius, image.columns) : 0;
  HoleImage wide = wrapped(image, wings);
  inpaint(wide, kInpaintingRadius);
  for (int row = 0; row < image.rows; ++row) {
    const auto from = wide.values.begin() + row * wide.columns + wings;
    std::copy_n(from, image.columns, image.values.begin() + row * image.columns);
  }
}

/// Sets columns with a direction of the sensor in the middle of each.
void take_columns_of(const SensorModel& sensor, DepthView& view) {
  const double width = sensor.azimuth_max - sensor.azimuth_min;
  const double steps = std::max(1.0, std::round(width / sensor.azimuth_step));
  // The last direction of a full turn is the first one again.
  view.columns = static_cast<int>(steps) + (view.is_full_turn ? 0 : 1);
  view.column_width = view.is_full_turn ? kTurn / steps : sensor.azimuth_step;
  view.azimuth_min = sensor.azimuth_min - 0.5 * view.column_width;
}

}  // namespace

DepthView view_for(const SensorModel& sensor, double farthest) {
  DepthView view;
  view.rows = rows_of(sensor);
  view.top = sensor.elevation_max;
  const double width = sensor.azimuth_max - sensor.azimuth_min;
  view.resolution = std::max(kFinestPixel, (view.top - sensor.elevation_min) / (view.rows - 1));
  view.azimuth_min = sensor.azimuth_min;
  view.is_full_turn = sensor.full_circle();
  view.column_width = view.resolution;
  // A whole number of columns must not become one more by rounding.
  view.columns = std::max(1, static_cast<int>(std::ceil(width / view.resolution - 1e-9)));
  constexpr double kAsFar = 0.999;  // Steps that are estimated from scans are not exact.
  if (sensor.azimuth_step >= kAsFar * view.resolution) take_columns_of(sensor, view);
  view.unit = std::max(std::min(farthest, sensor.range_max), 1.0) / kUnitsOfDepth;
  return view;
}

int DepthView::pixel_of(const Eigen::Vector3f& point) const {
  // Angles in single precision, which take half as long.
  const float flat = std::sqrt(point.x() * point.x() + point.y() * point.y());
  const double from_top = top + 0.5 * resolution - std::atan2(point.z(), flat);
  if (!(from_top >= 0.0)) return -1;
  const double row = from_top / resolution;
  if (!(row < rows)) return -1;
  double from_start = std::atan2(point.y(), point.x()) - azimuth_min;
  if (from_start < 0.0) from_start += kTurn;
  if (from_start >= kTurn) from_start -= kTurn;
  const double column = from_start / column_width;
  if (!(column >= 0.0 && column < columns)) return -1;
  return static_cast<int>(row) * columns + static_cast<int>(column);
}

Eigen::Vector3d DepthView::direction(int row, int column) const {
  const double elevation = top - row * resolution;
  const double azimuth = azimuth_min + (column + 0.5) * column_width;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

HoleImage depth_image(const Scan& scan, const DepthView& view) {
  HoleImage image{view.rows, view.columns, {}, {}};
  const auto size = static_cast<std::size_t>(view.rows) * static_cast<std::size_t>(view.columns);
  image.values.assign(size, 255);
  image.is_hole.assign(size, 1);
  for (const Eigen::Vector3f& point : scan.points) {
    const double depth = point.cast<double>().norm();
    if (!(depth >= kNearest && depth <= kUnitsOfDepth * view.unit)) continue;
    const int found = view.pixel_of(point);
    if (found < 0) continue;
    const auto pixel = static_cast<std::size_t>(found);
    image.values[pixel] =
        std::min(image.values[pixel], static_cast<std::uint8_t>(depth / view.unit));
    image.is_hole[pixel] = 0;
  }
  return image;
}

std::vector<std::uint8_t> open_holes(const HoleImage& image, bool is_full_turn) {
  std::vector<std::uint8_t> is_open(image.is_hole.size(), 0);
  std::vector<std::uint8_t> is_seen(image.is_hole.size(), 0);
  std::vector<int> hole;
  const auto visit = [&](int row, int column) {
    if (is_full_turn) column = (column + image.columns) % image.columns;
    if (row < 0 || row >= image.rows || column < 0 || column >= image.columns) return;
    const auto pixel = static_cast<std::size_t>(row * image.columns + column);
    if (image.is_hole[pixel] == 0 || is_seen[pixel] != 0) return;
    is_seen[pixel] = 1;
    hole.push_back(static_cast<int>(pixel));
  };
  for (int start = 0; start < image.columns; ++start) {
    hole.clear();
    visit(0, start);
    bool reaches_last_row = false;
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const int row = hole[i] / image.columns, column = hole[i] % image.columns;
      reaches_last_row |= row == image.rows - 1;
      visit(row - 1, column);
      visit(row + 1, column);
      visit(row, column - 1);
      visit(row, column + 1);
    }
    if (reaches_last_row) continue;
    for (const int pixel : hole) is_open[static_cast<std::size_t>(pixel)] = 1;
  }
  return is_open;
}

std::vector<Eigen::Vector3d> find_hole_ends(const Scan& scan, const DepthView& view) {
  std::vector<Eigen::Vector3d> ends;
  HoleImage image = depth_image(scan, view);
  const std::vector<std::uint8_t> is_open = open_holes(image, view.is_full_turn);
  if (std::find(is_open.begin(), is_open.end(), 1) == is_open.end()) return ends;
  fill_holes(image, view.is_full_turn);
  const int margin = static_cast<int>(std::ceil(kMargin / view.unit));
  for (int column = 0; column < view.columns; ++column) {
    for (int row = 0; row < view.rows; ++row) {
      const auto pixel = static_cast<std::size_t>(row * view.columns + column);
      const int depth = image.values[pixel] - margin;
      if (is_open[pixel] == 0 || depth <= 0) continue;
      ends.push_back(depth * view.unit * view.direction(row, column));
    }
  }
  return ends;
}

}  // namespace raymoval::freedom_method
