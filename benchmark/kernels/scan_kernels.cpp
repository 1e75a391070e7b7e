// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/workloads.h"
#include "core/simd/instruction_set_scope.h"
#include "methods/raymoval/map_reference.h"

namespace raymoval::kernels_bench {
namespace {

void project_scan(benchmark::State& state, const Workload& workload, InstructionSet set) {
  const Scan& scan = workload.sequence->scans[workload.sequence->scans.size() / 2];
  ProjectedScan projected;
  const InstructionSetScope scope(set);
  for (auto _ : state) {
    project(scan, paper_grid(), kPaperLimits.minimum_range, 1, projected);
    benchmark::DoNotOptimize(projected.bin.data());
  }
}

void references(benchmark::State& state, Workload& workload, InstructionSet set) {
  const Scan& scan = workload.sequence->scans[workload.sequence->scans.size() / 2];
  ProjectedScan projected;
  project(scan, paper_grid(), kPaperLimits.minimum_range, 1, projected);
  const FirstHitImage image =
      cast_first_hits(workload.map, scan.T_world_sensor, paper_grid(), kPaperLimits, 1);
  WindowPercentiles percentiles;
  const InstructionSetScope scope(set);
  for (auto _ : state) {
    windowed_percentiles(image.range, projected.minimum_range, paper_grid(), 1, {0.9, 0.1}, 1,
                         percentiles);
    benchmark::DoNotOptimize(percentiles.first.data());
  }
}

template <class Run>
void add(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_scan_kernels() {
  for (const auto& held : workloads()) {
    Workload& workload = *held;
    if (workload.name == "drive_with_trails") continue;  // The scans are those of the drive.
    for (const InstructionSet set : {InstructionSet::kPlain, InstructionSet::kBest}) {
      const std::string suffix = std::string("_") + instruction_set_name(set) + "/" + workload.name;
      add("project_scan" + suffix,
          [&workload, set](benchmark::State& state) { project_scan(state, workload, set); });
      add("window_percentiles" + suffix,
          [&workload, set](benchmark::State& state) { references(state, workload, set); });
    }
  }
}

}  // namespace raymoval::kernels_bench
