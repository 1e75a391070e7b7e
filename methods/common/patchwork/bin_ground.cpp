// SPDX-License-Identifier: MIT
#include "methods/common/patchwork/bin_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace raymoval::patchwork {
namespace {

/// In the innermost zone, what lies deeper than so many heights of the sensor is mirrored and no
/// measure of where the ground begins ('adaptive_seed_selection_margin' of Patchwork++).
constexpr double kDeepestGround = 1.2;

/// One bin while its planes are fitted.
class BinFit {
 public:
  BinFit(std::span<const Eigen::Vector3d> points, const BinSurroundings& surroundings,
         const GroundParameters& parameters, std::span<std::uint8_t> ground)
      : points_(points),
        parameters_(parameters),
        ground_(ground),
        left_(points.size(), 1),
        deepest_(surroundings.is_innermost ? -kDeepestGround * surroundings.sensor_height
                                           : -std::numeric_limits<double>::infinity()) {}

  /// R-VPF. @return whether any point is left
  bool take_walls_out() {
    for (int round = 0; round < parameters_.plane_rounds; ++round) {
      choose_seeds(parameters_.wall_seed_height);
      const Plane plane = fit_plane(points_, ground_).plane;
      if (plane.normal.z() >= parameters_.upright) return true;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (std::abs(plane.height_of(points_[i])) < parameters_.wall_distance) left_[i] = 0;
      }
      if (std::find(left_.begin(), left_.end(), 1) == left_.end()) return false;
    }
    return true;
  }

  /// R-GPF.
  PlaneFit fit_ground() {
    choose_seeds(parameters_.seed_height);
    PlaneFit fit = fit_plane(points_, ground_);
    for (int round = 0; round < parameters_.plane_rounds; ++round) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const bool is_near = fit.plane.height_of(points_[i]) < parameters_.ground_distance;
        ground_[i] = left_[i] != 0 && is_near ? 1 : 0;
      }
      // Some of the points that the plane was fitted to are not above it, so that some are chosen.
      fit = fit_plane(points_, ground_);
    }
    return fit;
  }

 private:
  /// Mean height of the lowest points that are left.
  double lowest_height() {
    heights_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (left_[i] != 0 && points_[i].z() >= deepest_) heights_.push_back(points_[i].z());
    }
    // All are deep: the ground falls. All of them seed it.
    if (heights_.empty()) return std::numeric_limits<double>::infinity();
    const std::size_t count =
        std::min(heights_.size(), static_cast<std::size_t>(parameters_.lowest_points));
    const auto end = heights_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(heights_.begin(), end - 1, heights_.end());
    std::sort(heights_.begin(), end);  // So that the order of points changes no digit.
    double sum = 0.0;
    for (auto height = heights_.begin(); height != end; ++height) sum += *height;
    return sum / static_cast<double>(count);
  }
  void choose_seeds(double above) {
    const double limit = lowest_height() + above;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      ground_[i] = left_[i] != 0 && points_[i].z() < limit ? 1 : 0;
    }
  }

  std::span<const Eigen::Vector3d> points_;
  const GroundParameters& parameters_;
  std::span<std::uint8_t> ground_;
  Mask left_;  ///< 1 = in no wall.
  double deepest_;
  std::vector<double> heights_;  ///< Scratch.
};

}  // namespace

std::optional<PlaneFit> find_bin_ground(std::span<const Eigen::Vector3d> points,
                                        const BinSurroundings& surroundings,
                                        const GroundParameters& parameters,
                                        std::span<std::uint8_t> ground) {
  BinFit bin(points, surroundings, parameters, ground);
  if (surroundings.is_innermost && !bin.take_walls_out()) {
    std::fill(ground.begin(), ground.end(), std::uint8_t{0});
    return std::nullopt;
  }
  return bin.fit_ground();
}

}  // namespace raymoval::patchwork
