// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval::registration {

/// The distance between the surfaces of two overlapping scans under the given poses.
struct PairDistance {
  std::size_t from = 0, to = 0;  ///< Positions of the scans, `from` < `to`.
  double distance_m = 0.0;       ///< RMS along the normals, without the sensor's noise.
  bool is_return = false;        ///< The path returned to the place of `from`.
};

/// How well poses fit the scans.
struct PoseFit {
  double distance_m = 0.0;  ///< Median over the pairs; 0 if there are none.
  double noise_m = 0.0;     ///< Median residual after registration: the sensor's noise.
  /// Pairs with enough overlap, sorted by `from`, then `to`. Empty if there are fewer than four.
  std::vector<PairDistance> pairs;
};

/// Above these, methods remove more than 2 % of static points (docs/poses.md has the measurements).
inline constexpr double kMostDistance = 0.05;        // metres, of half the pairs
inline constexpr double kMostDistanceOfPair = 0.07;  // metres

/// Length of the path up to each pose, metres.
std::vector<double> path_lengths(const std::vector<Pose>& poses);

/// The pair that fits worst. @param fit with pairs
const PairDistance& worst_pair(const PoseFit& fit);

/// Whether a median and a worst distance are within the limits.
inline bool is_within_limits(double median_m, double worst_m) {
  return median_m <= kMostDistance && worst_m <= kMostDistanceOfPair;
}
/// Whether a fit is within the limits; true without pairs.
bool fits(const PoseFit& fit);

/// Measures how well the poses of `scans` fit. Pairs of overlapping scans are registered; the
/// distance is how far registration moves surfaces. Pairs cover the whole sequence: stations
/// along the path, scans between them, every fourth station, and returns to a place. So each jump
/// of the poses lies between two scans of a pair.
/// @param threads the largest number of threads; the result does not depend on it
/// @throws DataError if a scan cannot be read; Cancelled
PoseFit measure_pose_fit(const ScanSource& scans, int threads,
                         const std::atomic<bool>* cancel = nullptr);

/// The distance of one pair; 0 if the scans do not overlap enough. @throws DataError as above
double measure_pair(const ScanSource& scans, std::size_t from, std::size_t to);

}  // namespace raymoval::registration
