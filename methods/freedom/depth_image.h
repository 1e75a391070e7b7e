// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/freedom/inpainting.h"

namespace raymoval::freedom_method {

/// The image of a scan: rows from the top of the view down, columns counter-clockwise.
struct DepthView {
  int rows = 0, columns = 0;
  double top = 0.0;           ///< Elevation of the middle of the first row, radians.
  double azimuth_min = 0.0;   ///< Where the first column begins, radians.
  double resolution = 0.0;    ///< Height of a pixel, radians.
  double column_width = 0.0;  ///< Radians; `resolution`, unless directions are farther apart.
  bool is_full_turn = false;  ///< The last column is beside the first.
  double unit = 0.0;          ///< Depth of one grey level, metres.

  /// The number of the pixel in which a point is; -1 if it is in none. @param point sensor frame
  [[nodiscard]] int pixel_of(const Eigen::Vector3f& point) const;
  /// The unit vector to the middle of a pixel, sensor frame.
  [[nodiscard]] Eigen::Vector3d direction(int row, int column) const;
};

/// The view of a sensor. Pixels are square, but where the directions of a beam are as far apart as
/// the beams or farther: then there is a column for each direction, which goes through its middle,
/// else columns between directions would be holes.
/// @param farthest metres; depths are 255th parts of this, or of the sensor's range
DepthView view_for(const SensorModel& sensor, double farthest);

/// The nearest depth in each pixel in units, rounded down, and holes where there is none.
HoleImage depth_image(const Scan& scan, const DepthView& view);

/// The pixels of the holes (joined across edges of pixels, and behind a full turn) that are open to
/// the top of the image and do not reach its last row; 1 each.
std::vector<std::uint8_t> open_holes(const HoleImage& image, bool is_full_turn);

/// Step 3: where rays without a return end, sensor frame, metres, column by column.
std::vector<Eigen::Vector3d> find_hole_ends(const Scan& scan, const DepthView& view);

}  // namespace raymoval::freedom_method
