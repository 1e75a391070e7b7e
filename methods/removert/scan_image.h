// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/removert/removert.h"

namespace raymoval::removert_method {

inline constexpr int kOutside = -1;  ///< The point is outside the field of view.
inline constexpr int kAmbiguous =
    -2;  ///< The point is too near to a pixel's border for single precision.

/// Pixels of a range image: rows from the top of the field of view down, columns with the azimuth
/// from behind the sensor (-180 deg) counter-clockwise; pixel = row * columns + column. As in the
/// public code, values are rounded to the nearest of R + 1 rows and C + 1 columns: the first row
/// has half a width, the last row one and a half. With a wrapped azimuth the last half column joins
/// the first.
class PixelGrid {
 public:
  /// R = round(V * resolution), C = round(H * resolution).
  PixelGrid(const Parameters& parameters, double resolution);

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int size() const { return rows_ * columns_; }
  [[nodiscard]] bool clamps() const { return clamp_; }
  [[nodiscard]] bool full_circle() const { return full_circle_; }
  [[nodiscard]] bool wraps() const { return wrap_; }

  /// Fractional row of an elevation in radians: R (1 - (el + V/2) / V).
  [[nodiscard]] double raw_row(double elevation) const {
    return 0.5 * rows_ - elevation * row_scale_;
  }
  /// Fractional column of an azimuth in radians: C (az + H/2) / H.
  [[nodiscard]] double raw_column(double azimuth) const {
    return 0.5 * columns_ + azimuth * column_scale_;
  }
  [[nodiscard]] double row_scale() const { return row_scale_; }
  [[nodiscard]] double column_scale() const { return column_scale_; }

  /// Pixel of a point in the sensor frame, or kOutside. The exact definition.
  [[nodiscard]] int pixel_of(const Eigen::Vector3d& point) const;

  /// Pixel of a fractional row and column in single precision: kAmbiguous if an error of
  /// `kMargin` pixels at one pixel per degree could change it.
  [[nodiscard]] int fast_pixel(float row, float column) const {
    if (row > kNearAxis) return kAmbiguous;
    if (clamp_) row = std::clamp(row, 0.0F, static_cast<float>(rows_) - 1.0F);
    const float row_up = row + 0.5F, column_up = column + 0.5F;
    const int row_cell = static_cast<int>(row_up), column_cell = static_cast<int>(column_up);
    const float row_part = row_up - static_cast<float>(row_cell);
    const float column_part = column_up - static_cast<float>(column_cell);
    const float low = std::min(row_part, column_part), high = std::max(row_part, column_part);
    if (!(low > margin_ && high < 1.0F - margin_)) {
      return surely_outside(row, column) ? kOutside : kAmbiguous;
    }
    if (near_field_border(row, column)) return kAmbiguous;
    return pixel_from(row, column, row_cell, column_cell);
  }

  /// Row values above this mark points too near to the sensor's axis for single precision.
  static constexpr float kNearAxis = 1e6F;

 private:
  [[nodiscard]] bool surely_outside(float row, float column) const {
    if (clamp_) return false;
    const bool outside_rows = row < -margin_ || row > static_cast<float>(rows_) + margin_;
    const bool outside_columns =
        !full_circle_ && (column < -margin_ || column > static_cast<float>(columns_) + margin_);
    return outside_rows || outside_columns;
  }
  [[nodiscard]] bool near_field_border(float row, float column) const {
    if (clamp_) return false;
    if (std::min(std::abs(row), std::abs(row - static_cast<float>(rows_))) < margin_) return true;
    return !full_circle_ &&
           std::min(std::abs(column), std::abs(column - static_cast<float>(columns_))) < margin_;
  }
  /// @param row_cell, column_cell the rounded row and column
  [[nodiscard]] int pixel_from(double row, double column, int row_cell, int column_cell) const {
    if (!clamp_) {
      if (row < 0.0 || row > rows_) return kOutside;
      if (!full_circle_ && (column < 0.0 || column > columns_)) return kOutside;
    }
    if (wrap_ && column_cell >= columns_) column_cell -= columns_;
    return std::clamp(row_cell, 0, rows_ - 1) * columns_ + std::clamp(column_cell, 0, columns_ - 1);
  }

  int rows_, columns_;
  double row_scale_, column_scale_;  ///< Pixels per radian.
  bool clamp_, wrap_, full_circle_;
  float margin_;  ///< Pixels.
};

/// Up to `kSize` points of the sensor frame with their pixels in a grid, in single precision, in
/// arrays that a compiler can vectorise.
struct PointBatch {
  static constexpr int kSize = 128;
  float x[kSize], y[kSize], z[kSize];             ///< In: sensor frame, metres.
  float row[kSize], column[kSize], range[kSize];  ///< Out: fractional pixel, 3-D range in metres.

  /// Fills the outputs of the first `count` points. The error of angles is at most 1e-6 rad. A
  /// point too near to the sensor's axis for this gets a row for which `fast_pixel` returns
  /// kAmbiguous.
  void project(const PixelGrid& grid, int count);
};

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
