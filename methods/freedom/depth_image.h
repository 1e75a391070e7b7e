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
/// from what is known. Each pixel is a mean of those known or filled that are not farther than
/// `radius`, weighted by
///  - direction: how far the way from them runs along the gradient of T,
///  - distance: one over its square,
///  - level set: one over 1 + the difference in T.
/// The publication extrapolates each of them by its own gradient. Here it is as OpenCV does it: the
/// mean's gradients are added with the wrong sign, scaled to a length of at most the square root of
/// 2, differences to both sides are four times as large, T beyond the image is taken for known and
/// very large, and pixels are rounded up.
///
/// The values under holes do not matter. Where nothing at all is known they become 0.
/// @note the publication is silent on: the order of equal T (that of pixels), differences at the
/// image's edge and beside holes (to the one side there is), T at a pixel's own filling (it is
/// solved before), and a direction across the gradient (it counts 1e-6)
void inpaint(HoleImage& image, int radius);

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
