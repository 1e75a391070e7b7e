// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan.h"
#include "core/sensor_model.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// What one scan says of a place.
enum class Seen : std::uint8_t { kUnknown, kAgree, kOccluded, kFree };

/// Nearest and farthest return of a scan in each direction, about one beam to a bin, and the
/// three-way test of a place against the bins around it.
class RangeImage {
 public:
  RangeImage(const SensorModel& sensor, const RaymovalPlusParameters& parameters);

  /// Replaces the image with that of `scan`.
  void fill(const Scan& scan);
  /// What the scan says of a place of the sensor frame (metres): **agree** if any return of the
  /// window lies at its range, else **occluded** if any is nearer, else **free** if there is a
  /// return at or below it, else **unknown**. Any agreement saves, any occlusion abstains.
  [[nodiscard]] Seen test(const Eigen::Vector3f& place) const;
  /// The same by a look at every bin of the window, without the short cut for most places.
  [[nodiscard]] Seen test_every_bin(const Eigen::Vector3f& place) const;

 private:
  /// Columns repeated at either end, so that no window has to wrap around.
  static constexpr int kMargin = 32;
  struct Bin {
    float nearest, farthest;
  };
  [[nodiscard]] const Bin* row(const std::vector<Bin>& bins, int r) const {
    return bins.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride_);
  }

  /// Nearest and farthest return of the least window around each bin.
  void fill_windows();
  struct Window {
    int column, center;  ///< Bin of the place; `center` may lie beyond the rows.
    int wide, high;      ///< Half sizes, bins.
  };
  [[nodiscard]] Window window_of(const Eigen::Vector3f& place, float range) const;
  [[nodiscard]] Seen test_bins(float range, const Window& window) const;

  RaymovalPlusParameters parameters_;
  float azimuth_step_, elevation_step_, elevation_min_;
  float half_voxel_, agree_constant_, agree_slope_, occluded_constant_, occluded_slope_;
  int columns_, rows_, stride_;
  std::vector<Bin> bins_, row_windows_, windows_;
};

}  // namespace raymoval
