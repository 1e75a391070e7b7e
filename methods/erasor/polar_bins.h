// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/scan/scan.h"
#include "methods/erasor/erasor.h"

namespace raymoval::erasor_method {

/// The volume of interest, divided into ring by sector bins (R-POD, region-wise pseudo occupancy
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

/// The result of the scan ratio test in a bin.
enum class BinFinding {
  kTooFewPoints,   ///< Too few query points for a test.
  kQueryOnly,      ///< The map has no points here.
  kMapHigher,      ///< The map has a tall object that the query does not have.
  kCurrentHigher,  ///< The query has a tall object that the map does not have.
  kEqual,          ///< Extents are similar, or both zero.
};

/// Compares the vertical extents of a bin (its pseudo occupancies): unequal if the smaller one is
/// strictly less than `threshold` times the larger one.
BinFinding compare_extents(const BinExtent& map, const BinExtent& query,
                           const Parameters& parameters);

/// The action on the map in a bin.
struct BinAction {
  bool remove = false;    ///< Map voxels above the ground are removed.
  bool reinsert = false;  ///< Voxels with a query point are put back.
};

/// Version 3: only bins where the map is higher, and taller than half a metre, change. Version 2:
/// the map must be higher than `minimum_top` instead, and bins of equal extents and bins with query
/// points only get the query's points.
BinAction action_for(BinFinding finding, const BinExtent& map, const Parameters& parameters);

/// R-GPF (region-wise ground plane fitting): which of a bin's map points are ground. `points` are
/// in the body frame, metres. All of them if there are no seeds.
/// @return 1 = ground, 0 = above it
Mask find_ground(const std::vector<Eigen::Vector3d>& points, const Parameters& parameters);

}  // namespace raymoval::erasor_method
