// SPDX-License-Identifier: MIT
// Voxel traversal after Amanatides and Woo (1987).
#include <algorithm>
#include <cmath>

#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::raymoval_method {
namespace {

/// An upper bound of the distance between two voxels, in voxels, which limits the walk for any
/// range limits.
constexpr double kLatticeDiagonal = 2.0 * 1.7320509 * kVoxelBias;

/// Walks a ray from cell to cell. Distances are in cells (a ray of unit direction in voxel units).
class Walk {
 public:
  Walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from)
      : origin_(origin), direction_(direction) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cell_[axis] = static_cast<int>(std::floor(origin[k] + from * direction[k]));
      // Bounded, so that 0 times it is 0: a ray this flat that starts on a wall crosses it at once.
      inverse_[axis] = direction[k] == 0.0 ? 0.0 : std::clamp(1.0 / direction[k], -1e300, 1e300);
      step_[axis] = direction[k] > 0.0 ? 1 : (direction[k] < 0.0 ? -1 : 0);
      // A ray along the negative axis that starts on a wall is in the lower cell at once, except at
      // its start.
      next_[axis] = exit_distance(axis);
      if (from > 0.0) distance_ = std::max(distance_, enter_distance(axis));
    }
  }

  [[nodiscard]] const std::array<int, 3>& cell() const { return cell_; }
  [[nodiscard]] double distance() const { return distance_; }

  void step_voxel() {
    advance(next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2));
  }

 private:
  /// Distance at which the ray leaves its cell along an axis.
  [[nodiscard]] double exit_distance(std::size_t axis) const {
    if (step_[axis] == 0) return std::numeric_limits<double>::infinity();
    return distance_to(axis, step_[axis] > 0 ? cell_[axis] + 1 : cell_[axis]);
  }
  /// Distance at which it entered its cell along an axis.
  [[nodiscard]] double enter_distance(std::size_t axis) const {
    if (step_[axis] == 0) return 0.0;
    return distance_to(axis, step_[axis] > 0 ? cell_[axis] : cell_[axis] + 1);
  }
  [[nodiscard]] double distance_to(std::size_t axis, double plane) const {
    return (plane - origin_[static_cast<Eigen::Index>(axis)]) * inverse_[axis];
  }
  void advance(std::size_t axis) {
    distance_ = std::max(distance_, next_[axis]);
    cell_[axis] += step_[axis];
    next_[axis] = exit_distance(axis);
  }

  Eigen::Vector3d origin_, direction_;
  std::array<int, 3> cell_{}, step_{};
  std::array<double, 3> inverse_{}, next_{};
  double distance_ = 0.0;
};

}  // namespace

std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, const RayLimits& limits,
                                 double from) {
  const double scale = map.inverse_voxel_size();
  const double nearest = limits.minimum_range * scale;
  // No voxel of the map is beyond the lattice, so rays end there.
  const double farthest = std::min(limits.maximum_range * scale, kLatticeDiagonal);
  Walk walk(ray.origin * scale, ray.direction, from * scale);
  for (; walk.distance() <= farthest; walk.step_voxel()) {
    const auto& [x, y, z] = walk.cell();
    if (walk.distance() >= nearest && map.contains({x, y, z})) {
      return FirstHit{walk.distance() * map.voxel_size(), {x, y, z}};
    }
  }
  return std::nullopt;
}

}  // namespace raymoval::raymoval_method
