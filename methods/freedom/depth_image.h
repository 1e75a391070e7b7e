// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"

namespace raymoval::freedom_method {

/// An image of bytes with holes, row by row.
struct HoleImage {
  int rows = 0, columns = 0;
  std::vector<std::uint8_t> values;
  std::vector<std::uint8_t> is_hole;  ///< 1 where there is no value.
};

/// Fills the holes after A. Telea: "An Image Inpainting Technique Based on the Fast Marching
/// Method", Journal of Graphics Tools 9 (2004). Holes are filled in the order of their distance T
/// from known pixels. Each pixel is a mean of the known or filled pixels within `radius`, weighted
/// by
///  - direction: the part of the distance along the gradient of T,
///  - distance: one over its square,
///  - level set: one over 1 + the difference in T.
/// The publication extrapolates each of them by its own gradient. This function follows OpenCV: the
/// mean's gradients are added with the wrong sign, scaled to a length of at most the square root of
/// 2, differences to both sides are four times as large, T beyond the image counts as known and
/// very large, and pixels are rounded up.
///
/// The values under holes have no effect. If no pixel is known, all become 0.
/// @note the publication does not define: the order of equal T (here that of pixels), differences
/// at the image's edge and beside holes (one-sided), T of a pixel while it is filled (solved
/// before), and a direction across the gradient (weight 1e-6)
void inpaint(HoleImage& image, int radius);

/// The image of a scan: rows from the top of the view down, columns counter-clockwise.
struct DepthView {
  int rows = 0, columns = 0;
  double top = 0.0;           ///< Elevation of the middle of the first row, radians.
  double azimuth_min = 0.0;   ///< Start of the first column, radians.
  double resolution = 0.0;    ///< Height of a pixel, radians.
  double column_width = 0.0;  ///< Radians; `resolution`, unless directions are farther apart.
  bool is_full_turn = false;  ///< The last column is beside the first.
  double unit = 0.0;          ///< Depth of one grey level, metres.

  /// The index of the pixel of a point; -1 outside the image. @param point sensor frame
  [[nodiscard]] int pixel_of(const Eigen::Vector3f& point) const;
  /// The unit vector to the middle of a pixel, sensor frame.
  [[nodiscard]] Eigen::Vector3d direction(int row, int column) const;
};

/// The view of a sensor. Pixels are square, unless the directions of a beam are at least as far
/// apart as the beams. Then each direction has a column, centred on it, because columns between
/// directions would be holes.
/// @param farthest metres; the depth unit is 1/255 of this, or of the sensor's range
DepthView view_for(const SensorModel& sensor, double farthest);

/// The nearest depth in each pixel in units, rounded down; holes without a depth.
HoleImage depth_image(const Scan& scan, const DepthView& view);

/// Marks (1) the pixels of the holes that are open to the top of the image and do not reach its
/// last row. Pixels of a hole are joined across edges, and across the seam of a full turn.
std::vector<std::uint8_t> open_holes(const HoleImage& image, bool is_full_turn);

/// Step 3: the ends of rays without a return, sensor frame, metres, column by column.
std::vector<Eigen::Vector3d> find_hole_ends(const Scan& scan, const DepthView& view);

}  // namespace raymoval::freedom_method
