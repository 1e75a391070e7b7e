// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>

#include "methods/erasor/parameters.h"

namespace raymoval::erasor_method {

/// The volume of interest cut into ring by sector bins (R-POD, region-wise pseudo occupancy
/// descriptor). Points are in the body frame: the sensor's axes, height 0 at the road below it.
class PolarBins {
 public:
  explicit PolarBins(const Parameters& parameters);

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rings_) * static_cast<std::size_t>(sectors_);
  }
  /// Bin (ring * sectors + sector) of a body point; -1 outside the height window (open at both
  /// ends) or beyond the range (which itself belongs to the last ring).
  [[nodiscard]] int bin_of(const Eigen::Vector3d& body) const;

 private:
  double range_, minimum_height_, maximum_height_;
  double rings_per_metre_, sectors_per_radian_;
  int rings_, sectors_;
};

/// Heights between which the points of a bin lie; their difference is the bin's pseudo occupancy.
struct BinExtent {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  int points = 0;

  void add(double height) {
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    ++points;
  }
  /// The pseudo occupancy, metres; 0 for an empty bin.
  [[nodiscard]] double extent() const { return points == 0 ? 0.0 : highest - lowest; }
};

}  // namespace raymoval::erasor_method
