// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/sight_kernels.h"

namespace raymoval {

/// What one scan says of a place.
enum class Seen : std::uint8_t { kUnknown, kAgree, kOccluded, kFree };

/// A place that a scan says something of.
struct SeenPlace {
  std::uint32_t place;  ///< Its number.
  Seen seen;            ///< kAgree or kFree.
  float range;          ///< Metres from the sensor.
};

/// Nearest and farthest return of a scan in each direction, about one beam to a bin, and the
/// three-way test of a place against the bins around it.
class RangeImage {
 public:
  /// @param set which kernels to use; the answer is the same for all
  RangeImage(const SensorModel& sensor, const RaymovalPlusParameters& parameters,
             InstructionSet set = InstructionSet::kBest);

  /// Bins of the image. At most about four million, whatever the sensor's steps.
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  }

  /// Replaces the image with that of `scan`.
  void fill(const Scan& scan);
  /// What the scan says of a place of the sensor frame (metres): **agree** if any return of the
  /// window lies at its range, else **occluded** if any is nearer, else **free** if there is a
  /// return at or below it, else **unknown**. Any agreement saves, any occlusion abstains. Looks at
  /// every bin of the window: slow, and what `see` has to come out as.
  [[nodiscard]] Seen test(const Eigen::Vector3f& place) const;
  /// Replaces `seen` with all places that the scan agrees with or sees through, ascending, as
  /// `test` has it. Most places need no look at their window, so this is many times faster.
  /// @param places x y z, x y z, ... of any frame, metres, not far from its origin
  void see(const std::vector<float>& places, const Pose& T_sensor_places,
           std::vector<SeenPlace>& seen) const;

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
    int wide, high;  ///< Half sizes, bins.
  };
  [[nodiscard]] Window window_at(float range) const {
    const float half = half_voxel_ / range;
    return {
        std::clamp(static_cast<int>(half / azimuth_step_), parameters_.window_columns, kMargin - 1),
        std::max(static_cast<int>(half / elevation_step_), parameters_.window_rows)};
  }
  [[nodiscard]] bool agrees_with(float range, const Bin& bin) const {
    const float agree = agree_constant_ + agree_slope_ * range;
    return std::abs(bin.nearest - range) <= agree || std::abs(bin.farthest - range) <= agree;
  }
  /// Looks at the window around a bin; `r` may lie beyond the rows.
  [[nodiscard]] Seen look(float range, int column, int r) const;

  RaymovalPlusParameters parameters_;
  kernels::SightKernels kernels_;
  kernels::SightGrid grid_;
  float azimuth_step_, elevation_step_;
  float half_voxel_, agree_constant_, agree_slope_, occluded_constant_, occluded_slope_;
  int columns_, rows_, stride_;
  std::vector<Bin> bins_, row_windows_, windows_;
};

}  // namespace raymoval
