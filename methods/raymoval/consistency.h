// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/first_hit.h"
#include "methods/raymoval/map_reference.h"

namespace raymoval::raymoval_method {

/// Margin that grows with range: tau0 + tau1 * r, metres.
struct RangeMargin {
  double tau0 = 0.3;  ///< Metres.
  double tau1 = 0.35;
  [[nodiscard]] double at(double range) const { return tau0 + tau1 * range; }
};

/// Eq. 11 for every point with its own range: 1 where the map reference of its bin is farther than
/// the point by more than the margin at the point's range. Points outside all bins, and bins
/// without a map reference, give 0.
Mask check_consistency(const ProjectedScan& scan, const std::vector<float>& map_reference,
                       const RangeMargin& margin, int threads = 1);

/// Distance along a ray in which its height changes by `height` metres, at most `limit`. A return
/// within this distance behind a first hit may be on the same ground, seen at a grazing angle
/// through the empty upper part of its voxels.
/// @param vertical z of the ray's unit direction in the world
double grazing_distance(double vertical, double height, double limit);

/// A bin through which a scan sees.
struct SeenThrough {
  int bin;
  float nearest_return;  ///< The nearest return in the bin's neighbourhood, metres.
};

/// The opposite case, "erase" in the paper's overview: bins through which the scan sees. The
/// nearest return of the bin's neighbourhood is beyond the map reference by more than the margin at
/// the map's range, and beyond the bin's own first hit by more than the margin's constant part.
/// Only bins with a return.
/// @param neighbourhood of each bin
std::vector<SeenThrough> find_seen_through(const ProjectedScan& scan,
                                           const BinWindow& neighbourhood,
                                           const FirstHitImage& first_hit,
                                           const std::vector<float>& map_reference,
                                           const RangeMargin& margin, int threads);

}  // namespace raymoval::raymoval_method
