// SPDX-License-Identifier: MIT
// Voxel traversal after Amanatides and Woo (1987) on two levels: bricks of 8^3 voxels that are not
// in the map are crossed in one step.
#include <algorithm>
#include <cmath>

#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::raymoval_method {
namespace {

/// An upper bound of the distance between two voxels, in voxels: the walk's, whatever the limits
/// are.
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
      // A ray along the negative axis that starts on a wall is in the lower cell at once, but for
      // the start itself.
      next_[axis] = exit_distance(axis, cell_[axis], 1);
      if (from > 0.0) distance_ = std::max(distance_, enter_distance(axis, cell_[axis]));
    }
  }

  [[nodiscard]] const std::array<int, 3>& cell() const { return cell_; }
  [[nodiscard]] double distance() const { return distance_; }

  void step_voxel() {
    advance(next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2));
  }

  /// Goes to the first cell outside the present brick.
  void leave_brick() {
    constexpr int kSide = OccupancyMap::kBrickSide;
    std::size_t first = 0;
    std::array<double, 3> exits;
    for (std::size_t k = 0; k < 3; ++k) {
      exits[k] = exit_distance(k, cell_[k] & ~(kSide - 1), kSide);
      if (exits[k] < exits[first]) first = k;
    }
    distance_ = std::max(distance_, exits[first]);
    for (std::size_t k = 0; k < 3; ++k) {
      const int low = cell_[k] & ~(kSide - 1);
      if (k == first) {
        cell_[k] = step_[k] > 0 ? low + kSide : low - 1;
      } else if (step_[k] != 0) {
        const auto axis = static_cast<Eigen::Index>(k);
        const int at = static_cast<int>(std::floor(origin_[axis] + distance_ * direction_[axis]));
        cell_[k] = std::clamp(at, low, low + kSide - 1);
      }
      next_[k] = exit_distance(k, cell_[k], 1);
    }
  }

 private:
  /// Distance at which the ray leaves the block of `side` cells from `low` along an axis.
  [[nodiscard]] double exit_distance(std::size_t axis, int low, int side) const {
    if (step_[axis] == 0) return std::numeric_limits<double>::infinity();
    const double plane = step_[axis] > 0 ? low + side : low;
    return (plane - origin_[static_cast<Eigen::Index>(axis)]) * inverse_[axis];
  }
  /// Distance at which the ray enters the cells `low` .. `low + 1` of an axis.
  [[nodiscard]] double enter_distance(std::size_t axis, int low) const {
    if (step_[axis] == 0) return 0.0;
    const double plane = step_[axis] > 0 ? low : low + 1;
    return (plane - origin_[static_cast<Eigen::Index>(axis)]) * inverse_[axis];
  }
  void advance(std::size_t axis) {
    distance_ = std::max(distance_, next_[axis]);
    cell_[axis] += step_[axis];
    next_[axis] = exit_distance(axis, cell_[axis], 1);
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
  // No voxel of the map lies beyond the lattice, so that no ray has to go on there.
  const double farthest = std::min(limits.maximum_range * scale, kLatticeDiagonal);
  Walk walk(ray.origin * scale, ray.direction, from * scale);
  while (walk.distance() <= farthest) {
    const VoxelIndex entry(walk.cell()[0], walk.cell()[1], walk.cell()[2]);
    const Eigen::Vector3i brick_at = OccupancyMap::brick_of(entry);
    const Brick* brick = map.find_brick(brick_at);
    if (brick == nullptr) {
      walk.leave_brick();
      continue;
    }
    while (walk.distance() <= farthest) {
      const auto& [x, y, z] = walk.cell();
      if (OccupancyMap::brick_of({x, y, z}) != brick_at) break;
      if (walk.distance() >= nearest && brick->contains(x, y, z)) {
        return FirstHit{walk.distance() * map.voxel_size(), {x, y, z}};
      }
      walk.step_voxel();
    }
  }
  return std::nullopt;
}

}  // namespace raymoval::raymoval_method
