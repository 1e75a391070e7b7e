// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "benchmark/kernels/workloads.h"
#include "core/error.h"
#include "core/simd/instruction_set_scope.h"
#include "methods/raymoval/kernels/first_hit.h"

namespace raymoval::kernels_bench {
namespace {

// The usual way to find first hits, for comparison: one ray after the other.

/// All rays of an image, and the destination of their ranges.
struct ImageJob {
  const FirstHitImage* frame = nullptr;  ///< Grid, pose, limits and directions.
  std::vector<float>* range = nullptr;
};

/// The map's bounding box as a block of bits.
class DenseBits {
 public:
  /// @throws DataError if the block would be larger than 256 MiB
  explicit DenseBits(const OccupancyMap& map);
  [[nodiscard]] bool contains(std::int64_t bit) const {
    return (words_[static_cast<std::size_t>(bit >> 5)] >> (bit & 31) & 1U) != 0;
  }
  [[nodiscard]] const Eigen::Vector3i& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] double voxel_size() const { return voxel_size_; }
  [[nodiscard]] std::array<std::int64_t, 3> strides() const {
    return {static_cast<std::int64_t>(size_.z()) * size_.y(), size_.z(), 1};
  }

 private:
  Eigen::Vector3i low_, size_;
  double voxel_size_;
  std::vector<std::uint32_t> words_;
};

/// Calls `visit` with the index of each occupied voxel, in the order of the map's bricks.
template <class Visit>
void for_voxels(const OccupancyMap& map, Visit&& visit) {
  for (std::size_t tile = 0; tile < map.tile_count(); ++tile) {
    for (const OccupancyMap::BrickHead& head : map.tile(tile)) {
      const Brick& brick = map.brick(head.slot);
      for (int k = 0; k < 512; ++k) {
        const VoxelIndex voxel(head.at[0] * 8 + (k >> 6), head.at[1] * 8 + (k >> 3 & 7),
                               head.at[2] * 8 + (k & 7));
        if (brick.contains(voxel.x(), voxel.y(), voxel.z())) visit(voxel);
      }
    }
  }
}

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

/// Amanatides and Woo in float with accumulated planes. @return the number of steps made
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

/// Casts one image into the job's range. @return the number of steps; 0 if the design does not
/// count them
using Design = std::function<std::int64_t(Workload&, const ImageJob&)>;

/// The frame of an image (pose, limits, directions) with the right ranges.
const FirstHitImage& frame_at(Workload& workload, std::size_t pose) {
  static std::map<std::pair<const Workload*, std::size_t>, FirstHitImage> frames;
  FirstHitImage& frame = frames[{&workload, pose}];
  if (frame.range.empty()) {
    frame = cast_first_hits(workload.map, workload.views[pose], paper_grid(), kPaperLimits, 1);
  }
  return frame;
}

/// Bins in which two images differ by more than a millimetre.
std::int64_t bins_off(const std::vector<float>& a, const std::vector<float>& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    count += std::abs(a[i] - b[i]) > 1e-3F ? 1 : 0;
  }
  return count;
}

/// One iteration casts one image from each pose.
void run_design(benchmark::State& state, Workload& workload, const Design& design) {
  std::vector<float> range;
  std::int64_t steps = 0, off = 0;
  for (std::size_t pose = 0; pose < workload.views.size(); ++pose) {  // Also warms up.
    const ImageJob job{&frame_at(workload, pose), &range};
    steps += design(workload, job);
    off += bins_off(range, job.frame->range);
  }
  for (auto _ : state) {
    for (std::size_t pose = 0; pose < workload.views.size(); ++pose) {
      design(workload, {&frame_at(workload, pose), &range});
      benchmark::DoNotOptimize(range.data());
    }
  }
  state.SetLabel(std::to_string(workload.map.size()) + " voxels");
  const auto images = static_cast<double>(workload.views.size());
  const double rays = images * paper_grid().size();
  state.counters["images_per_iteration"] = images;
  if (steps > 0) state.counters["steps_per_ray"] = static_cast<double>(steps) / rays;
  state.counters["bins_off_by_1_mm"] = static_cast<double>(off);
}

void add(const std::string& name, Workload& workload, const Design& design) {
  benchmark::RegisterBenchmark((name + "/" + workload.name).c_str(), [&workload, design](
                                                                         benchmark::State& state) {
    try {
      run_design(state, workload, design);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  })->Unit(benchmark::kMillisecond);
}

void add_yardstick(Workload& workload) {
  const auto bits = std::make_shared<std::unique_ptr<DenseBits>>();  // Made at the first use.
  add("dense_bitset_dda", workload, [bits](Workload& w, const ImageJob& job) {
    if (!*bits) *bits = std::make_unique<DenseBits>(w.map);
    return dense_bitset_dda(**bits, job);
  });
}

Design sweep_with(InstructionSet set, int threads) {
  const InstructionSetScope scope(set);
  const auto caster = std::make_shared<FirstHitCaster>(paper_grid(), kPaperLimits);
  const auto image = std::make_shared<FirstHitImage>();
  return [caster, image, threads, set](Workload& workload, const ImageJob& job) {
    const InstructionSetScope scope_of_cast(set);
    caster->cast(workload.map, job.frame->T_world_sensor, threads, *image);
    std::swap(image->range, *job.range);
    return std::int64_t{0};
  };
}

void add_ours(Workload& workload) {
  add("first_hit_image", workload, sweep_with(InstructionSet::kBest, 1));
  for (const InstructionSet set : supported_instruction_sets()) {
    add(std::string("first_hit_image_") + instruction_set_name(set), workload, sweep_with(set, 1));
  }
  add("first_hit_image_2_threads", workload, sweep_with(InstructionSet::kBest, 2));
  add("first_hit_image_and_all_voxels", workload, [](Workload& w, const ImageJob& job) {
    static FirstHitCaster caster(paper_grid(), kPaperLimits);
    static FirstHitImage image;
    caster.cast(w.map, job.frame->T_world_sensor, 1, image);
    for (int bin = 0; bin < image.grid.size(); ++bin) {
      benchmark::DoNotOptimize(image.voxel(w.map, bin));
    }
    *job.range = image.range;
    return std::int64_t{0};
  });
}

}  // namespace

void register_image_kernels() {
  for (const auto& workload : workloads()) {
    add_yardstick(*workload);
    add_ours(*workload);
  }
}

}  // namespace raymoval::kernels_bench
