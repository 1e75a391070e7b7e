// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>

#include "benchmark/kernels/ray_designs.h"
#include "benchmark/kernels/workloads.h"
#include "core/simd/instruction_set_scope.h"

namespace raymoval::kernels_bench {
namespace {

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
