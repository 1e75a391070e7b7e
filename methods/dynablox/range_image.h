// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/dynablox/parameters.h"

namespace raymoval::dynablox_method {

/// Coefficients of atan(a) = a P(a a) for 0 <= a <= 1, right to 1e-6: the polynomial that agrees at
/// Chebyshev's nodes.
inline constexpr std::array<float, 7> kArcTangent = {
    0.9999992256F,  -0.3332567804F,  0.1987204027F,  -0.1344786406F,
    0.08312645301F, -0.03636043086F, 0.007648353927F};
inline constexpr float kHalfTurn = 3.14159265358979F;
inline constexpr float kQuarterTurn = 1.57079632679490F;
inline constexpr float kLeastDivisor = 1e-30F;

/// atan2(y, x) to 2e-6, in the same operations as the kernel's.
float arc_tangent(float y, float x);

/// The spherical image of ranges around a sensor. Columns go around the whole circle from azimuth
/// -pi, each as wide as the next; rows go up, the first and the last are centred on the ends of the
/// vertical field of view.
struct ImageGrid {
  int columns = 0, rows = 0;
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F;
  float elevation_min = 0.0F;  ///< Of the centre of row 0, radians.

  ImageGrid(const Parameters& parameters, const SensorModel& sensor);

  /// A pixel of the stored image; the stored rows have an empty one below and above, and the stored
  /// columns the first one again behind the last.
  [[nodiscard]] std::size_t stored(int column, int row) const {
    return static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(columns + 1) +
           static_cast<std::size_t>(column);
  }
};

/// Ranges of a scan's nearest returns, metres; 0 where there is none.
class RangeImage {
 public:
  explicit RangeImage(const ImageGrid& grid) : grid_(grid) {}

  /// Takes the place of the last scan's. Returns nearer than `min_range` are left out, those beyond
  /// `max_range` are as far as a voxel within can be told from them, or left out if not clearing.
  void fill(const Scan& scan, const Parameters& parameters, float max_range);

  [[nodiscard]] const ImageGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<float>& ranges() const { return ranges_; }

 private:
  ImageGrid grid_;
  std::vector<float> ranges_;
};

}  // namespace raymoval::dynablox_method
