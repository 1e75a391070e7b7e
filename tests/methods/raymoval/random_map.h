// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::random_map {

using namespace raymoval_method;

/// The same numbers on every platform.
class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_()) / 4294967296.0);
  }
  /// low .. high, ends included.
  int integer(int low, int high) {
    return std::min(high, static_cast<int>(std::floor(real(low, high + 1.0))));
  }

 private:
  std::mt19937 bits_;
};

/// A floor with holes, walls, blocks and loose voxels within `reach` cells of `centre`.
inline void fill(OccupancyMap& map, const VoxelIndex& centre, int reach, Random& random) {
  const auto offset = [&] { return random.integer(-reach, reach); };
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      if (random.real(0, 1) < 0.8) map.insert(centre + VoxelIndex(x, y, -reach / 4));
    }
  }
  for (int wall = 0; wall < 4; ++wall) {
    const VoxelIndex corner = centre + VoxelIndex(offset(), offset(), -reach / 4);
    const bool along_x = random.integer(0, 1) == 0;
    const int length = random.integer(3, reach), height = random.integer(2, reach);
    for (int i = 0; i < length; ++i) {
      for (int z = 0; z < height; ++z) {
        map.insert(corner + (along_x ? VoxelIndex(i, 0, z) : VoxelIndex(0, i, z)));
      }
    }
  }
  for (int k = 0; k < 40 * reach; ++k) {
    map.insert(centre + VoxelIndex(offset(), offset(), offset()));
  }
}

inline Pose pose(const Eigen::Vector3d& position, Random& random, double largest_tilt) {
  const auto angle = [&](double most) { return random.real(-most, most); };
  Pose T = Pose::Identity();
  T.translation() = position;
  T.linear() = (Eigen::AngleAxisd(angle(std::numbers::pi), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(angle(largest_tilt), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(angle(largest_tilt), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

/// Whether a ray passes a voxel within `tolerance` of its surface: it meets the voxel grown by that
/// much on all sides, and misses the one shrunk by it.
inline bool grazes(const Ray& ray, const VoxelIndex& voxel, double voxel_size, double tolerance) {
  const auto meets = [&](double grow) {
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double low = voxel[k] * voxel_size - grow - ray.origin[k];
      const double high = (voxel[k] + 1) * voxel_size + grow - ray.origin[k];
      const double a = low / ray.direction[k], b = high / ray.direction[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  };
  return meets(tolerance) && !meets(-tolerance);
}

/// What came of comparing an image with `cast_ray`, ray by ray.
struct Comparison {
  int bins = 0;
  int hits = 0;
  int ties = 0;   ///< The two disagree about a voxel that the ray only grazes.
  int wrong = 0;  ///< They disagree otherwise.
};

inline Comparison compare_with_rays(const OccupancyMap& map, const FirstHitImage& image) {
  constexpr double kTolerance = 1e-4;
  Comparison result;
  for (int bin = 0; bin < image.grid.size(); ++bin) {
    const Ray ray = image.ray(bin);
    const auto expected = cast_ray(map, ray, image.limits);
    const double range = image.range[static_cast<std::size_t>(bin)];
    ++result.bins;
    result.hits += expected ? 1 : 0;
    if (!expected && std::isinf(range)) continue;
    if (expected && std::abs(expected->range - range) <= kTolerance) {
      if (image.voxel(map, bin) == expected->voxel) continue;
    }
    bool is_tie = expected && grazes(ray, expected->voxel, map.voxel_size(), kTolerance);
    const VoxelIndex at =
        std::isinf(range) ? VoxelIndex(0, 0, 0) : map.voxel_of(ray.origin + range * ray.direction);
    for (int k = 0; k < 27 && !is_tie && !std::isinf(range); ++k) {
      const VoxelIndex voxel = at + VoxelIndex(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      is_tie = map.contains(voxel) && grazes(ray, voxel, map.voxel_size(), kTolerance);
    }
    // At the ends of the range a rounding decides whether a voxel counts.
    const double end = expected ? expected->range : range;
    is_tie |= std::abs(end - image.limits.maximum_range) < kTolerance ||
              std::abs(end - image.limits.minimum_range) < kTolerance ||
              std::abs(range - image.limits.minimum_range) < kTolerance;
    ++(is_tie ? result.ties : result.wrong);
  }
  return result;
}

}  // namespace raymoval::random_map
