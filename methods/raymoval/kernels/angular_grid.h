// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::raymoval_method {

inline constexpr float kNoRange = std::numeric_limits<float>::infinity();

/// Direction of a point in the sensor frame (eq. 1).
struct Spherical {
  double range;      ///< r = |p|, metres.
  double azimuth;    ///< atan2(y, x), in (-pi, pi].
  double elevation;  ///< asin(z / r), in [-pi/2, pi/2].
};
/// Eq. 1. A point at the origin has direction (0, 0).
Spherical to_spherical(const Eigen::Vector3d& point);

/// Azimuth-elevation grid of directions around the sensor (eqs 2-5). The azimuth covers the full
/// circle, the elevation [elevation_min, elevation_max); bins are numbered row by row,
/// `bin = j * azimuth_bins + i`.
struct AngularGrid {
  int azimuth_bins = 720;
  int elevation_bins = 450;
  double elevation_min = 0.0;  ///< Radians.
  double elevation_max = 0.0;

  [[nodiscard]] int size() const { return azimuth_bins * elevation_bins; }
  [[nodiscard]] double azimuth_step() const;    ///< Delta_az, eq. 2.
  [[nodiscard]] double elevation_step() const;  ///< Delta_el, eq. 2.
  [[nodiscard]] int azimuth_of(int bin) const { return bin % azimuth_bins; }
  [[nodiscard]] int elevation_of(int bin) const { return bin / azimuth_bins; }

  /// Eq. 3. No value outside the vertical field of view: points are not clamped into the border
  /// row.
  [[nodiscard]] std::optional<int> bin_of(double azimuth, double elevation) const;
  [[nodiscard]] double azimuth_centre(int i) const;    ///< Eq. 4.
  [[nodiscard]] double elevation_centre(int j) const;  ///< Eq. 4.
  /// Eq. 5: unit vector of the bin's centre in the sensor frame.
  [[nodiscard]] Eigen::Vector3d direction(int bin) const;
};

/// A scan sorted into the bins of a grid.
struct ProjectedScan {
  std::vector<float> range;       ///< The range of each point, metres.
  std::vector<std::int32_t> bin;  ///< The bin of each point; -1 outside all bins.
  std::vector<float>
      minimum_range;  ///< d_scan of each bin (eq. 10), metres; infinite if it is empty.
};

/// Eqs 1-3 and 10. Points nearer than `minimum_range` (the ego vehicle) get no bin.
/// @param projected replaced; its memory is used again
void project(const Scan& scan, const AngularGrid& grid, double minimum_range, int threads,
             ProjectedScan& projected);

/// The column of a full circle for `i`, which may be up to one turn outside.
inline int wrap_azimuth(int i, int azimuth_bins) {
  return i < 0 ? i + azimuth_bins : (i >= azimuth_bins ? i - azimuth_bins : i);
}

/// The wanted bins of a grid, whose first hits are required: one bit each, column by column.
class WantedBins {
 public:
  /// Marks all bins as wanted.
  void request_all(const AngularGrid& grid);
  /// Marks the bins within `radius` columns and rows of each bin where `values` is finite. The
  /// azimuth wraps around.
  /// @param values one per bin of `grid`
  void request_around(const std::vector<float>& values, const AngularGrid& grid, int radius);

  /// The wanted rows of column `i`: bit j % 64 of word j / 64 is row j. The bit after the last row
  /// exists and is never set.
  [[nodiscard]] const std::uint64_t* column(int i) const {
    return columns_.data() + static_cast<std::size_t>(i) * words_;
  }
  [[nodiscard]] std::size_t words_a_column() const { return words_; }
  [[nodiscard]] bool contains(const AngularGrid& grid, int bin) const {
    const auto row = static_cast<std::size_t>(grid.elevation_of(bin));
    return (column(grid.azimuth_of(bin))[row / 64] >> row % 64 & 1) != 0;
  }

 private:
  std::size_t words_ = 0;
  std::vector<std::uint64_t> columns_;
  std::vector<std::uint64_t> finite_;  ///< Kept for its memory.
};

}  // namespace raymoval::raymoval_method
