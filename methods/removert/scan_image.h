// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/removert/pixel_grid.h"

namespace raymoval::removert_method {

/// Largest values of an image over rectangles, bounded from above by a pyramid of maxima.
class MaximumPyramid {
 public:
  /// @param image `rows * columns` values, row by row
  MaximumPyramid(const std::vector<float>& image, int rows, int columns);

  /// An upper bound of the values in rows [row_from, row_to] and columns [column_from, column_to].
  /// The ends are included and inside the image.
  [[nodiscard]] float bound(int row_from, int row_to, int column_from, int column_to) const;
  [[nodiscard]] float top() const { return levels_.back().values.front(); }

 private:
  struct Level {
    int rows, columns;
    std::vector<float> values;
  };
  std::vector<Level> levels_;
};

/// The map points that a pass checks.
enum class Candidates {
  kInFront,  ///< The points clearly in front of the scan, which suffice to find the dynamic ones.
  kAll,      ///< All points in pixels where the scan has a return.
};

/// Range image I_Q of a scan.
struct ScanImage {
  /// @param points sensor at the origin, metres
  ScanImage(const std::vector<Eigen::Vector3f>& points, const PixelGrid& pixel_grid,
            const Parameters& parameters, Candidates candidates);

  PixelGrid grid;
  std::vector<float> nearest;  ///< Metres; -1 without a point.
  /// A map point is checked if its range is below this limit: I_Q - tau, infinite for all points,
  /// or -1 for none.
  std::vector<float> limit;
  MaximumPyramid limit_pyramid;
};

/// tau: how much nearer than I_Q = `range` a map point must be, metres.
float threshold(float range, const Parameters& parameters);

}  // namespace raymoval::removert_method
