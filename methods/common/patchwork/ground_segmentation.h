// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/patchwork/bin_ground.h"
#include "methods/common/patchwork/ground_thresholds.h"
#include "methods/common/patchwork/zones.h"

namespace raymoval::patchwork {

/// S. Lee, H. Lim, H. Myung: "Patchwork++: Fast and Robust Ground Segmentation Solving Partial
/// Under-Segmentation Using 3D Point Cloud", IROS 2022. Tells which points of a scan are ground:
///  1. RNR: points mirrored to below the ground are none.
///  2. The others fall into bins of rings and sectors around the sensor, in a frame whose z is up.
///  3. R-VPF, R-GPF: each bin's walls are taken out and its plane is found.
///  4. A plane is ground if it is upright and, near the sensor, low enough or flat enough.
///  5. TGR: a plane that is neither is ground after all if it is about as flat as the other ground
///     of its ring.
///  6. A-GLE: what is low enough and flat enough is told by the planes of all scans before.
/// Scans are to be given in order, since each adapts what the next ones are compared with.
class GroundSegmentation {
 public:
  explicit GroundSegmentation(const GroundParameters& parameters);

  /// One value per point, 1 = ground. The answer does not depend on `threads`.
  Mask find_ground(const Scan& scan, int threads);
  /// What the next scan will be compared with.
  [[nodiscard]] const GroundThresholds& thresholds() const { return thresholds_; }

 private:
  /// The plane of a bin.
  struct BinPlane {
    std::optional<PlaneFit> fit;
    [[nodiscard]] double elevation() const { return fit->centre.z(); }
    /// Variance across the plane, square metres.
    [[nodiscard]] double flatness() const { return variance(0); }
    /// Variances along its longer and its shorter side, square metres.
    [[nodiscard]] double length_squared() const { return variance(2); }
    [[nodiscard]] double width_squared() const { return variance(1); }
    [[nodiscard]] bool faces_sensor() const { return fit->centre.dot(fit->plane.normal) < 0.0; }

   private:
    /// Of the sample, along the principal axis `axis`.
    [[nodiscard]] double variance(int axis) const {
      const double count = fit->points;
      return count > 1.0 ? fit->variances[axis] * count / (count - 1.0) : 0.0;
    }
  };

  void place_points(const Scan& scan, int threads);
  [[nodiscard]] bool is_mirrored(const Eigen::Vector3d& point, const Scan& scan,
                                 std::size_t i) const;
  void fit_bins(int threads);
  void find_sensor_height();
  /// Steps 4 and 5 for a ring; its bins that are no ground lose their ground points.
  void judge_ring(int ring);
  [[nodiscard]] bool is_like_ring(const BinPlane& plane,
                                  const std::deque<double>& flatnesses) const;
  void drop_ground(int bin);
  [[nodiscard]] std::size_t begin(int bin) const { return begin_[static_cast<std::size_t>(bin)]; }
  [[nodiscard]] std::size_t points_in(int bin) const { return begin(bin + 1) - begin(bin); }

  GroundParameters parameters_;
  ZoneModel zones_;
  GroundThresholds thresholds_;
  bool is_height_known_;
  // Of the scan that is looked at.
  std::vector<Eigen::Vector3d> level_;    ///< Its points in the frame whose z is up.
  std::vector<int> bin_;                  ///< The bin of each point.
  std::vector<std::size_t> begin_;        ///< Where each bin's points begin in the next three.
  std::vector<std::uint32_t> point_;      ///< The points, by bins, in their order in the scan.
  std::vector<Eigen::Vector3d> in_bins_;  ///< Their places.
  std::vector<std::uint8_t> ground_;      ///< Their verdicts.
  std::vector<BinPlane> planes_;
};

}  // namespace raymoval::patchwork
