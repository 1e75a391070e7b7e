// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/dynablox/parameters.h"
#include "methods/dynablox/voxel_kernels.h"

namespace raymoval::dynablox_method {

/// The spherical image of ranges around a sensor. Columns go around the whole circle from azimuth
/// -pi, each as wide as the next; rows go up, the first and the last are centred on the ends of the
/// vertical field of view.
struct ImageGrid {
  int columns = 0, rows = 0;
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F;
  float elevation_min = 0.0F;  ///< Of the centre of row 0, radians.
  float pixels_per_square_radian = 0.0F;

  /// What the sensor's model does not know, or cannot be, is as published.
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
  explicit RangeImage(const ImageGrid& grid) : grid_(grid), kernels_(kernels::best_kernels()) {}

  /// Takes the place of the last scan's. Returns nearer than `min_range` are left out, as are those
  /// beyond `max_range` if they say nothing. Where the mean of pixels is asked for, those beyond
  /// are as far as a voxel within can be told from them.
  void fill(const Scan& scan, const Parameters& parameters, float max_range);

  [[nodiscard]] const ImageGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<float>& ranges() const { return ranges_; }

 private:
  /// Calls `visit(pixel, range)` for each point that is in a pixel.
  template <class Visit>
  void for_pixels(const Scan& scan, const kernels::Projection& job, Visit&& visit);

  ImageGrid grid_;
  kernels::Kernels kernels_;
  std::vector<float> ranges_;
  std::vector<std::int32_t> pixels_;  ///< Of points, and
  std::vector<float> seen_;           ///< their ranges.
};

}  // namespace raymoval::dynablox_method
