// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/workloads.h"
#include "methods/raymoval/map_reference.h"
#include "methods/registry.h"

namespace raymoval::kernels_bench {
namespace {

/// Scans held in memory: reading them is not what is measured.
class HeldScans : public ScanSource {
 public:
  explicit HeldScans(const Workload& workload) : workload_(workload) {}
  [[nodiscard]] std::size_t size() const override {
    return std::min<std::size_t>(workload_.sequence->scans.size(), 60);
  }
  [[nodiscard]] Scan load(std::size_t i) const override {
    Scan scan = workload_.sequence->scans[i];
    scan.index = i;
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t i) const override {
    return workload_.sequence->scans[i].T_world_sensor;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return workload_.sequence->sensor; }

 private:
  const Workload& workload_;
};

class NoMasks : public RemovalSink {
 public:
  void accept(std::size_t, const Mask& mask) override { benchmark::DoNotOptimize(mask.data()); }
};

/// The whole online method; one iteration is a pass over the scans.
void online(benchmark::State& state, const Workload& workload, int threads) {
  const HeldScans scans(workload);
  const ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval:online");
  StageTimes times;
  RunContext context;
  context.threads = threads;
  context.times = &times;
  for (auto _ : state) {
    NoMasks sink;
    method.make()->run(scans, sink, context);
  }
  const auto passes = static_cast<double>(state.iterations()) * static_cast<double>(scans.size());
  for (const StageTimes::Stage& stage : times.stages()) {
    state.counters["ms_" + stage.name] = stage.seconds * 1e3 / passes;
  }
  state.counters["scans_per_iteration"] = static_cast<double>(scans.size());
  state.counters["points_per_scan"] = static_cast<double>(workload.sequence->points) /
                                      static_cast<double>(workload.sequence->scans.size());
}

void project_scan(benchmark::State& state, const Workload& workload, InstructionSet set) {
  const Scan& scan = workload.sequence->scans[workload.sequence->scans.size() / 2];
  ProjectedScan projected;
  for (auto _ : state) {
    project(scan, paper_grid(), kPaperLimits.minimum_range, 1, projected, set);
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
  for (auto _ : state) {
    windowed_percentiles(image.range, projected.minimum_range, paper_grid(), 1, {0.9, 0.1}, 1,
                         percentiles, set);
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
    for (const int threads : {1, 2}) {
      add("raymoval_online_" + std::to_string(threads) + "/" + workload.name,
          [&workload, threads](benchmark::State& state) { online(state, workload, threads); });
    }
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
