// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/patchwork/parameters.h"
#include "methods/common/plane_fit.h"

namespace raymoval::patchwork {

/// The concentric zone model: four zones around the sensor, each with rings of equal width and
/// sectors of equal angle.
class ZoneModel {
 public:
  static constexpr int kNone = -1;
  static constexpr std::array<int, 4> kRings{2, 4, 4, 4};
  static constexpr std::array<int, 4> kSectors{16, 32, 54, 32};
  static constexpr int kAllRings = 14;
  static constexpr int kAllBins = 2 * 16 + 4 * 32 + 4 * 54 + 4 * 32;

  /// @param from, to horizontal distances of the start of the first and the end of the last zone,
  /// metres
  ZoneModel(double from, double to);

  /// The bin of a place, `kNone` outside all zones. Sector 0 begins at +x and goes toward +y.
  [[nodiscard]] int bin_of(double x, double y) const;
  /// The first bin of a ring; that of ring `kAllRings` is `kAllBins`.
  [[nodiscard]] static int first_bin(int ring);
  [[nodiscard]] static bool is_innermost_zone(int bin) { return bin < kRings[0] * kSectors[0]; }

 private:
  std::array<double, 5> bounds_;  ///< Starts of the zones and end of the last one, metres.
};

/// Innermost rings in which a plane must be low or flat to be ground. Beyond, any upright plane is
/// ground.
inline constexpr int kProvedRings = 4;

struct MeanAndDeviation {
  double mean = 0.0, deviation = 0.0;
};
/// The mean, and the standard deviation of a sample, which is 0 for one value.
/// @param values at least one
MeanAndDeviation mean_and_deviation(const std::deque<double>& values);

/// Thresholds for the planes of each of the innermost rings. They adapt after each scan.
class GroundThresholds {
 public:
  /// @param sensor_height metres above the ground; infinite where it is unknown
  explicit GroundThresholds(double sensor_height) : sensor_height_(sensor_height) {}

  [[nodiscard]] double sensor_height() const { return sensor_height_; }
  void set_sensor_height(double height) { sensor_height_ = height; }
  /// A plane with a mean height above the sensor below this is low enough, metres.
  [[nodiscard]] double elevation(int ring) const { return rings_.at(index(ring)).elevation; }
  /// A plane with a least variance below this is flat enough, square metres.
  [[nodiscard]] double flatness(int ring) const { return rings_.at(index(ring)).flatness; }

  /// Stores a plane of a ring that was low enough. The last 1,000 planes of each ring are used.
  void store(int ring, double elevation, double flatness);
  /// Updates the thresholds from the stored planes. The planes of the innermost ring also give a
  /// new sensor height.
  void adapt();

 private:
  struct Ring {
    double elevation = 0.0, flatness = 0.0;
    std::deque<double> elevations, flatnesses;
  };
  static std::size_t index(int ring) { return static_cast<std::size_t>(ring); }

  double sensor_height_;
  std::array<Ring, kProvedRings> rings_;
};

/// The surroundings of a bin: in the innermost zone there may be mirrored points below the ground,
/// and walls next to the sensor.
struct BinSurroundings {
  bool is_innermost = false;
  double sensor_height = 0.0;  ///< Metres above the ground; infinite where it is unknown.
};

/// R-VPF and R-GPF (region-wise fits of vertical and of ground planes): finds the lowest plane of a
/// bin, after walls are removed in the innermost zone.
/// @param points level frame with the sensor at the origin, metres; at least one
/// @param ground as long as the points; set to 1 for the points near or below the plane
/// @return the plane through those points; no value if all points belong to walls
std::optional<PlaneFit> find_bin_ground(std::span<const Eigen::Vector3d> points,
                                        const BinSurroundings& surroundings,
                                        const GroundParameters& parameters,
                                        std::span<std::uint8_t> ground);

/// S. Lee, H. Lim, H. Myung: "Patchwork++: Fast and Robust Ground Segmentation Solving Partial
/// Under-Segmentation Using 3D Point Cloud", IROS 2022. Finds the ground points of a scan:
///  1. RNR: points mirrored to below the ground are not ground.
///  2. The other points are sorted into bins of rings and sectors around the sensor, with z up.
///  3. R-VPF, R-GPF: each bin's walls are removed and its plane is found.
///  4. A plane is ground if its normal is upright and, near the sensor, it is low or flat enough.
///  5. TGR: a plane that is neither is ground if it is about as flat as the other ground of its
///     ring.
///  6. A-GLE: the thresholds of step 4 follow from the planes of all earlier scans.
/// Scans must be given in order, because each scan adapts the thresholds for the next ones.
class GroundSegmentation {
 public:
  explicit GroundSegmentation(const GroundParameters& parameters);

  /// One value per point, 1 = ground. The result does not depend on `threads`.
  Mask find_ground(const Scan& scan, int threads);
  /// The thresholds for the next scan.
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
  /// Steps 4 and 5 for a ring: removes the ground points of its bins that are not ground.
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
  // Of the current scan.
  std::vector<Eigen::Vector3d> level_;    ///< Its points in the frame whose z is up.
  std::vector<int> bin_;                  ///< The bin of each point.
  std::vector<std::size_t> begin_;        ///< First index of each bin in the next three vectors.
  std::vector<std::uint32_t> point_;      ///< The points, by bins, in their order in the scan.
  std::vector<Eigen::Vector3d> in_bins_;  ///< Their positions.
  std::vector<std::uint8_t> ground_;      ///< Their verdicts.
  std::vector<BinPlane> planes_;
};

}  // namespace raymoval::patchwork
