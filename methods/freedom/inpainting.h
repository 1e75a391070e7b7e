// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace raymoval::freedom_method
