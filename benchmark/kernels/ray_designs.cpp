// SPDX-License-Identifier: MIT
#include "benchmark/kernels/ray_designs.h"

#include <cmath>

#include "core/error.h"

namespace raymoval::kernels_bench {
namespace {

/// Calls `cast(ray, range)` for each requested bin.
template <class Cast>
void for_rays(const ImageJob& job, Cast&& cast) {
  const FirstHitImage& frame = *job.frame;
  job.range->assign(static_cast<std::size_t>(frame.grid.size()), kNoRange);
  for (int bin = 0; bin < frame.grid.size(); ++bin) {
    const auto at = static_cast<std::size_t>(bin);
    (*job.range)[at] = cast(frame.ray(bin));
  }
}

/// A walk in float from the minimum range on, in voxel units.
struct FloatWalk {
  std::array<int, 3> cell;
  std::array<int, 3> step;
  std::array<float, 3> next, delta;

  FloatWalk(const Ray& ray, double minimum_range, double voxel_size) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double direction = ray.direction[k];
      const double start = (ray.origin[k] + minimum_range * direction) / voxel_size;
      cell[axis] = static_cast<int>(std::floor(start));
      step[axis] = direction >= 0.0 ? 1 : -1;
      const double inverse = 1.0 / std::max(std::abs(direction), 1e-12);
      delta[axis] = static_cast<float>(inverse * voxel_size);
      const double part = direction >= 0.0 ? cell[axis] + 1 - start : start - cell[axis];
      next[axis] = static_cast<float>(minimum_range + part * inverse * voxel_size);
    }
  }
  [[nodiscard]] std::size_t axis() const {
    return next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
  }
};

}  // namespace

DenseBits::DenseBits(const OccupancyMap& map) : voxel_size_(map.voxel_size()) {
  low_ = Eigen::Vector3i::Constant(kVoxelLimit);
  Eigen::Vector3i high = Eigen::Vector3i::Constant(-kVoxelLimit);
  for_voxels(map, [&](const VoxelIndex& voxel) {
    low_ = low_.cwiseMin(voxel);
    high = high.cwiseMax(voxel);
  });
  size_ = (high - low_).array() + 1;
  const std::int64_t bits = size_.cast<std::int64_t>().prod();
  if (bits >= std::int64_t{1} << 31) {
    throw DataError("the map is too wide for a dense block of bits (" + std::to_string(bits >> 23) +
                    " MiB, at most 255); use a shorter sequence.");
  }
  words_.assign(static_cast<std::size_t>(bits / 32 + 1), 0);
  const auto stride = strides();
  for_voxels(map, [&](const VoxelIndex& voxel) {
    const Eigen::Vector3i at = voxel - low_;
    const std::int64_t bit = at.x() * stride[0] + at.y() * stride[1] + at.z();
    words_[static_cast<std::size_t>(bit >> 5)] |= 1U << (bit & 31);
  });
}

std::int64_t dense_bitset_dda(const DenseBits& bits, const ImageJob& job) {
  const auto [x_stride, y_stride, z_stride] = bits.strides();
  const auto limits = job.frame->limits;
  const auto farthest = static_cast<float>(limits.maximum_range);
  std::int64_t steps = 0;
  for_rays(job, [&](const Ray& ray) {
    FloatWalk walk(ray, limits.minimum_range, bits.voxel_size());
    const std::array<std::int64_t, 3> stride = {walk.step[0] * x_stride, walk.step[1] * y_stride,
                                                walk.step[2] * z_stride};
    std::array<int, 3> left;  // Steps until the ray leaves the block.
    std::int64_t bit = 0;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const int at = walk.cell[k] - bits.low()[axis];
      inside &= at >= 0 && at < bits.size()[axis];
      left[k] = walk.step[k] > 0 ? bits.size()[axis] - 1 - at : at;
    }
    if (!inside) return kNoRange;
    bit = (walk.cell[0] - bits.low().x()) * x_stride + (walk.cell[1] - bits.low().y()) * y_stride +
          (walk.cell[2] - bits.low().z());
    while (true) {
      const std::size_t axis = walk.axis();
      const float range = walk.next[axis];
      if (range > farthest || left[axis] == 0) return kNoRange;
      --left[axis];
      walk.next[axis] += walk.delta[axis];
      bit += stride[axis];
      ++steps;
      if (bits.contains(bit)) return range;
    }
  });
  return steps;
}

}  // namespace raymoval::kernels_bench
