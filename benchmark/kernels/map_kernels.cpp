// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <memory>
#include <random>

#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/workloads.h"

namespace raymoval::kernels_bench {
namespace {

constexpr int kChanges = 25000;  // About the voxels that a scan adds.

/// The city of one size; only one is held at a time.
OccupancyMap& city(std::size_t voxels) {
  static std::size_t held_size = 0;
  static std::unique_ptr<OccupancyMap> held;
  if (held_size != voxels) {
    held.reset();
    held = std::make_unique<OccupancyMap>(city_of(voxels));
    held_size = voxels;
  }
  return *held;
}

/// Empty voxels above the ground around a place, in runs like the points of a scan.
std::vector<VoxelIndex> new_voxels(std::size_t voxels, unsigned seed) {
  std::mt19937 random(seed);
  const int reach = static_cast<int>(city_reach(voxels) / 0.2) - 210;
  const auto pick = [&](int most) {
    return static_cast<int>(random() % (2U * static_cast<unsigned>(std::max(most, 1)))) - most;
  };
  const int x = pick(reach), y = pick(reach);
  std::vector<VoxelIndex> list;
  while (list.size() < kChanges) {
    const VoxelIndex start(x + pick(200), y + pick(200), -7 + static_cast<int>(random() % 8));
    for (int k = 0; k < 10; ++k) list.push_back(start + VoxelIndex(k, k / 2, 0));
  }
  return list;
}

Pose pose_in_city() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(3.03, -2.07, 0.13);
  return pose;
}

void measure(benchmark::State& state, std::size_t voxels, const char* what) {
  // The bricks, their boxes, and twice the capacity while the map grows.
  const std::size_t needed = voxels * 30 + (std::size_t{1} << 30);
  if (available_memory() != 0 && available_memory() < needed) {
    state.SkipWithError("not enough free memory for a map of this size");
    return;
  }
  OccupancyMap& map = city(voxels);
  const std::string kind = what;
  unsigned seed = 1;
  FirstHitCaster caster(paper_grid(), kPaperLimits);
  FirstHitImage image;
  std::int64_t found = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const std::vector<VoxelIndex> list = new_voxels(voxels, seed++);
    if (kind == "erase") {
      for (const VoxelIndex& voxel : list) map.insert(voxel);
      map.update_boxes(1);
    }
    if (kind == "upkeep") {
      for (const VoxelIndex& voxel : list) map.insert(voxel);
    }
    if (kind == "image") caster.cast(map, pose_in_city(), 1, image);
    state.ResumeTiming();
    if (kind == "insert") {
      for (const VoxelIndex& voxel : list) map.insert(voxel);
    } else if (kind == "erase") {
      for (const VoxelIndex& voxel : list) map.erase(voxel);
    } else if (kind == "lookup") {
      for (const VoxelIndex& voxel : list) found += map.contains(voxel) ? 1 : 0;
    } else if (kind == "upkeep") {
      map.update_boxes(1);
    } else {
      caster.cast(map, pose_in_city(), 1, image);
    }
    state.PauseTiming();
    if (kind != "image" && kind != "lookup") {
      for (const VoxelIndex& voxel : list) map.erase(voxel);
      map.update_boxes(1);
    }
    state.ResumeTiming();
  }
  benchmark::DoNotOptimize(found);
  state.counters["voxels"] = static_cast<double>(map.size());
  state.counters["bytes_per_voxel"] =
      static_cast<double>(map.memory_bytes()) / static_cast<double>(map.size());
  if (kind == "insert" || kind == "erase" || kind == "lookup") {
    state.counters["per_operation"] = benchmark::Counter(
        kChanges, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }
}

}  // namespace

void register_map_kernels() {
  // Sizes one after the other: only one map is held.
  for (const std::size_t voxels : {100'000UL, 1'000'000UL, 10'000'000UL, 100'000'000UL}) {
    for (const char* what : {"insert", "erase", "lookup", "upkeep", "image"}) {
      benchmark::RegisterBenchmark(
          ("map_" + std::string(what) + "/" + std::to_string(voxels)).c_str(),
          [voxels, what](benchmark::State& state) { measure(state, voxels, what); })
          ->Unit(benchmark::kMillisecond)
          ->Iterations(20);
    }
  }
}

}  // namespace raymoval::kernels_bench
