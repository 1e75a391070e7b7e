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

namespace {

/// Eq. 7 with `find_brick(brick coordinates)` as the way to the map.
template <class FindBrick>
std::optional<FirstHit> walk_to_first_hit(const FindBrick& find_brick, double voxel_size,
                                          const Ray& ray, double minimum_range,
                                          double maximum_range) {
  const double scale = 1.0 / voxel_size;
  const double nearest = minimum_range * scale;
  const double farthest = maximum_range * scale;
  Walk walk(ray.origin * scale, ray.direction);
  while (walk.distance() <= farthest) {
    const VoxelIndex entry(walk.cell()[0], walk.cell()[1], walk.cell()[2]);
    const Eigen::Vector3i brick_at = OccupancyMap::brick_of(entry);
    const OccupancyMap::Brick* brick = find_brick(brick_at);
    if (brick == nullptr) {
      walk.leave_brick();
      continue;
    }
    while (walk.distance() <= farthest) {
      const auto& [x, y, z] = walk.cell();
      if (OccupancyMap::brick_of({x, y, z}) != brick_at) break;
      if (walk.distance() >= nearest && brick->contains(x, y, z)) {
        return FirstHit{walk.distance() * voxel_size, {x, y, z}};
      }
      walk.step_voxel();
    }
  }
  return std::nullopt;
}

/// The bricks within reach of a sensor in a dense block, so that rays find them without hashing.
/// Filled by look-ups around the sensor: its cost depends on the range and not on the map.
class LocalBricks {
 public:
  static constexpr std::int64_t kLargest = 8'000'000;

  LocalBricks(const OccupancyMap& map, const Eigen::Vector3d& position, double range) : map_(map) {
    const double side = map.voxel_size() * OccupancyMap::kBrickSide;
    const int reach = static_cast<int>(std::min(std::ceil(range / side) + 1.0, 1e6));
    low_ = OccupancyMap::brick_of(map.voxel_of(position)).array() - reach;
    high_ = low_.array() + 2 * reach;
    low_ = low_.cwiseMax(map.lowest_brick());
    high_ = high_.cwiseMin(map.highest_brick());
    size_ = (high_ - low_).array() + 1;
    if ((size_.array() <= 0).any()) return;
    if (size_.cast<std::int64_t>().prod() > kLargest) return;
    bricks_.reserve(static_cast<std::size_t>(size_.prod()));
    for (int z = low_.z(); z <= high_.z(); ++z) {
      for (int y = low_.y(); y <= high_.y(); ++y) {
        for (int x = low_.x(); x <= high_.x(); ++x) bricks_.push_back(map.find_brick({x, y, z}));
      }
    }
  }

  [[nodiscard]] const OccupancyMap::Brick* operator()(const Eigen::Vector3i& brick) const {
    const Eigen::Vector3i at = brick - low_;
    if ((at.array() < 0).any() || (at.array() >= size_.array()).any()) return nullptr;
    if (bricks_.empty()) return map_.find_brick(brick);
    return bricks_[static_cast<std::size_t>((at.z() * size_.y() + at.y()) * size_.x() + at.x())];
  }

 private:
  const OccupancyMap& map_;
  Eigen::Vector3i low_, high_, size_;
  std::vector<const OccupancyMap::Brick*> bricks_;
};

}  // namespace

std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, double minimum_range,
                                 double maximum_range) {
  const auto find_brick = [&](const Eigen::Vector3i& brick) { return map.find_brick(brick); };
  return walk_to_first_hit(find_brick, map.voxel_size(), ray, minimum_range, maximum_range);
}

FirstHitImage cast_first_hits(const OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, double minimum_range, double maximum_range,
                              int threads) {
  FirstHitImage image;
  const auto bins = static_cast<std::size_t>(grid.size());
  image.range.assign(bins, kNoRange);
  image.voxel.assign(bins, 0);
  if (map.size() == 0) return image;
  const Eigen::Vector3d origin = T_world_sensor.translation();
  const LocalBricks bricks(map, origin, maximum_range);
  const DirectionTable directions(grid);
  const auto rows = static_cast<std::size_t>(grid.elevation_bins);
  const auto columns = static_cast<std::size_t>(grid.azimuth_bins);
  parallel_for(threads, rows, 8, [&](std::size_t row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const Ray ray{origin, T_world_sensor.linear() * directions.at(i, row)};
      const auto hit =
          walk_to_first_hit(bricks, map.voxel_size(), ray, minimum_range, maximum_range);
      if (!hit) continue;
      image.range[row * columns + i] = static_cast<float>(hit->range);
      image.voxel[row * columns + i] = voxel_key(hit->voxel);
    }
  });
  return image;
}

}  // namespace raymoval
