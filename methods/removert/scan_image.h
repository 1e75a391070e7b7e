// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "methods/removert/pixel_grid.h"

namespace raymoval::removert_method {

/// Largest values of an image over rectangles, bounded from above by a pyramid of maxima.
class MaximumPyramid {
 public:
  /// @param image `rows * columns` values, row by row
  MaximumPyramid(const std::vector<float>& image, int rows, int columns);

  /// At least the largest value in rows [row_from, row_to], columns [column_from, column_to], ends
  /// inclusive and inside the image.
  [[nodiscard]] float bound(int row_from, int row_to, int column_from, int column_to) const;
  [[nodiscard]] float top() const { return levels_.back().values.front(); }

 private:
  struct Level {
    int rows, columns;
    std::vector<float> values;
  };
  std::vector<Level> levels_;
};

/// Which map points a pass looks at.
enum class Candidates {
  kInFront,  ///< Those clearly in front of the scan: enough to find the dynamic ones.
  kAll,      ///< All in pixels where the scan has a return.
};

/// Points of a scan in the axes in which it is projected: its own, or the world's.
/// @param world_axes turn them by the scan's rotation
std::vector<Eigen::Vector3f> points_in_image_axes(const Scan& scan, bool world_axes);

/// Range image I_Q of a scan.
struct ScanImage {
  /// @param points sensor at the origin, metres
  ScanImage(const std::vector<Eigen::Vector3f>& points, const PixelGrid& pixel_grid,
            const RemovertParameters& parameters, Candidates candidates);

  PixelGrid grid;
  std::vector<float> nearest;  ///< Metres; -1 where no point is.
  /// A map point is looked at if its range is below this: I_Q - tau, everything, or nothing (-1).
  std::vector<float> limit;
  MaximumPyramid limit_pyramid;
};

/// tau: how much nearer than I_Q = `range` a map point must be, metres.
float threshold(float range, const RemovertParameters& parameters);

}  // namespace raymoval::removert_method
