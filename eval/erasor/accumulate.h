// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/checked_scan.h"
#include "eval/erasor/options.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// Semantic id of the trucks that early published tables count as static.
inline constexpr std::uint16_t kMovingTruck = 258;

/// What became of the points of all scans. The first four counts add up to the points that were
/// read.
struct PointCounts {
  std::int64_t out_of_range = 0;  ///< Outside the range limits.
  std::int64_t ignored = 0;       ///< Of an ignored label class.
  std::int64_t cropped = 0;       ///< Too near to the sensor's z axis.
  std::int64_t evaluated = 0;     ///< Everything else.
  std::int64_t removed = 0;       ///< Evaluated points that the mask flags.
  std::int64_t trucks = 0;        ///< Evaluated points of label id 258.

  PointCounts& operator+=(const PointCounts& other);
};

/// The dense map: the points of each scan that are evaluated and not flagged, voxelised scan by
/// scan, one scan after the other.
struct DenseMap {
  LabelledCloud cloud;
  std::int64_t mixed_label_ties = 0;
  PointCounts points;
  std::vector<std::size_t> scan_ends;  ///< For each scan, how many points lie before its end.

  /// Scan from which point `point` of the cloud comes.
  [[nodiscard]] std::uint32_t scan_of(std::uint32_t point) const;
};

/// The label rule as the options want it: id 258 moves only with `truck_is_moving`.
LabelRule effective_rule(const LabelRule& rule, const Options& options);

/// The points of a scan that are evaluated and not flagged.
struct PlacedScan {
  LabelledCloud cloud;  ///< World frame, lifted.
  PointCounts points;
};

/// Steps 1 to 3 of the ground truth for one scan: crop, lift in the sensor frame, pose. Points that
/// the mask flags are left out.
PlacedScan place_scan(const CheckedScan& scan, const EvaluationInput& input, const Options& options,
                      const LabelClasses& classes);

/// A scan's part of the dense map.
struct DenseScan {
  LabelledVoxels voxels;
  PointCounts points;
};

/// The same, and step 4: label-preserving voxelisation.
DenseScan dense_scan(const CheckedScan& scan, const EvaluationInput& input, const Options& options,
                     const LabelClasses& classes);

/// Step 5 for the next scan: append.
void append(const DenseScan& scan, DenseMap& dense);

/// Steps 1 to 5 for all scans. No point is flagged.
/// @param task shown as progress
/// @throws DataError if a scan's labels do not fit it
DenseMap accumulate(const EvaluationInput& input, const Options& options,
                    const LabelClasses& classes, const std::string& task);

}  // namespace raymoval::erasor
