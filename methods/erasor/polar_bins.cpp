// SPDX-License-Identifier: MIT
#include "methods/erasor/polar_bins.h"

#include <cmath>
#include <numbers>

namespace raymoval::erasor_method {

PolarBins::PolarBins(const Parameters& parameters)
    : range_(parameters.maximum_range),
      minimum_height_(parameters.minimum_height),
      maximum_height_(parameters.maximum_height),
      rings_per_metre_(parameters.rings / parameters.maximum_range),
      sectors_per_radian_(parameters.sectors / (2.0 * std::numbers::pi)),
      rings_(parameters.rings),
      sectors_(parameters.sectors) {}

int PolarBins::bin_of(const Eigen::Vector3d& body) const {
  if (!(body.z() > minimum_height_ && body.z() < maximum_height_)) return -1;
  const double square = body.x() * body.x() + body.y() * body.y();
  if (!(square <= range_ * range_)) return -1;
  const int ring = std::min(static_cast<int>(std::sqrt(square) * rings_per_metre_), rings_ - 1);
  double theta = std::atan2(body.y(), body.x());
  // Also for y = -0 and x < 0, where the angle is -pi and a test of y alone would let it pass.
  if (theta < 0.0) theta += 2.0 * std::numbers::pi;
  const int sector = std::min(static_cast<int>(theta * sectors_per_radian_), sectors_ - 1);
  return ring * sectors_ + sector;
}

}  // namespace raymoval::erasor_method
