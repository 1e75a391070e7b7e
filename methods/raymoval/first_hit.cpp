// SPDX-License-Identifier: MIT
// Voxel traversal after Amanatides and Woo (1987) on two levels: bricks of 8^3 voxels that are not
// in the map are crossed in one step.
#include "methods/raymoval/first_hit.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace raymoval {
namespace {

/// Walks a ray from cell to cell. Distances are in cells (a ray of unit direction in voxel units).
class Walk {
 public:
  Walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)
      : origin_(origin), direction_(direction) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cell_[axis] = static_cast<int>(std::floor(origin[k]));
      inverse_[axis] = direction[k] == 0.0 ? 0.0 : 1.0 / direction[k];
      step_[axis] = direction[k] > 0.0 ? 1 : (direction[k] < 0.0 ? -1 : 0);
      // A ray along the negative axis that starts on a wall is in the lower cell at once, but for
      // the start itself.
      next_[axis] = exit_distance(axis, cell_[axis], 1);
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

std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, double minimum_range,
                                 double maximum_range) {
  const double scale = 1.0 / map.voxel_size();
  const double nearest = minimum_range * scale;
  const double farthest = maximum_range * scale;
  Walk walk(ray.origin * scale, ray.direction);
  Eigen::Vector3i brick_at(1 << 30, 0, 0);
  const OccupancyMap::Brick* brick = nullptr;
  while (walk.distance() <= farthest) {
    const auto& [x, y, z] = walk.cell();
    const Eigen::Vector3i here = OccupancyMap::brick_of({x, y, z});
    if (here != brick_at) {
      brick = map.find_brick(here);
      brick_at = here;
    }
    if (brick == nullptr) {
      walk.leave_brick();
      continue;
    }
    if (walk.distance() >= nearest && brick->contains(x, y, z)) {
      return FirstHit{walk.distance() * map.voxel_size(), {x, y, z}};
    }
    walk.step_voxel();
  }
  return std::nullopt;
}

FirstHitImage cast_first_hits(const OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, double minimum_range, double maximum_range,
                              int threads) {
  FirstHitImage image;
  const auto bins = static_cast<std::size_t>(grid.size());
  image.range.assign(bins, kNoRange);
  image.voxel.assign(bins, 0);
  parallel_for(threads, bins, 4096, [&](std::size_t bin) {
    const Ray ray{T_world_sensor.translation(),
                  T_world_sensor.linear() * grid.direction(static_cast<int>(bin))};
    if (const auto hit = cast_ray(map, ray, minimum_range, maximum_range)) {
      image.range[bin] = static_cast<float>(hit->range);
      image.voxel[bin] = voxel_key(hit->voxel);
    }
  });
  return image;
}

}  // namespace raymoval
