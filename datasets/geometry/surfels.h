// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// A small piece of surface in a scan: a patch of a plane, or of a thin pole.
struct Surfel {
  enum class Group : std::uint8_t { kNormalX, kNormalY, kNormalZ, kLine };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Normal of a plane, direction of a pole.
  Group group = Group::kNormalZ;  ///< Axis of the scan's frame that the normal is nearest to.

  [[nodiscard]] bool is_line() const { return group == Group::kLine; }
};

/// `points` farther than 3 m from the sensor. Nearer points may be of the ego vehicle, which moves
/// along with the sensor.
std::vector<Eigen::Vector3f> without_near(std::vector<Eigen::Vector3f> points);

/// The surfels of a scan in its own frame, in a fixed order: one for each cell of 0.8 m whose
/// points (at least six) lie on a plane or on a pole.
std::vector<Surfel> find_surfels(const std::vector<Eigen::Vector3f>& points);

/// The part of a shift along directions that at least `fewest` surfels constrain. A plane
/// constrains its normal, a pole the directions across it. The ground alone constrains only the
/// vertical.
Eigen::Vector3d held_part(const Eigen::Vector3d& shift, const std::vector<Surfel>& surfels,
                          double fewest);

/// The surfels of one scan, to which those of another scan are compared.
class SurfaceMap {
 public:
  explicit SurfaceMap(std::vector<Surfel> surfels);

  /// Agreement of `surfels`, moved by `motion`, with this map, 0 to 1. Each surfel counts
  /// 1 - distance / `reach` to the nearest similar surfel (plane to plane along the normal, pole to
  /// pole across it), or 0. The mean of each group is taken first, so that the ground does not
  /// outvote the few surfaces across the direction of travel.
  [[nodiscard]] double agreement(const std::vector<Surfel>& surfels, const Pose& motion,
                                 double reach = 0.2) const;

  /// `motion` improved by Gauss-Newton steps on the same distances.
  [[nodiscard]] Pose refine(const std::vector<Surfel>& surfels, const Pose& motion,
                            int steps = 12) const;

 private:
  [[nodiscard]] const Surfel* nearest(const Surfel& moved) const;
  std::vector<Surfel> surfels_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace raymoval
