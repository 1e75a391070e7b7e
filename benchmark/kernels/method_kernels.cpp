// SPDX-License-Identifier: MIT
// The whole scan loop.
#include <benchmark/benchmark.h>

#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/workloads.h"
#include "methods/registry.h"

namespace raymoval::kernels_bench {
namespace {

constexpr std::size_t kScans = 60;

/// Scans held in memory: neither reading nor copying them is measured.
class HeldScans : public ScanSource {
 public:
  HeldScans(const Workload& workload, benchmark::State& state)
      : sequence_(*workload.sequence), state_(state) {}
  [[nodiscard]] std::size_t size() const override {
    return std::min(sequence_.scans.size(), kScans);
  }
  [[nodiscard]] Scan load(std::size_t i) const override {
    state_.PauseTiming();
    Scan scan = sequence_.scans[i];
    scan.index = i;
    state_.ResumeTiming();
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t i) const override {
    return sequence_.scans[i].T_world_sensor;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return sequence_.sensor; }

 private:
  const HeldSequence& sequence_;
  benchmark::State& state_;
};

class CountingSink : public RemovalSink {
 public:
  void accept(std::size_t, const Mask& mask) override {
    removed += std::count(mask.begin(), mask.end(), 1);
  }
  std::int64_t removed = 0;
};

/// One iteration is a pass over the scans.
template <class Make>
void run_method(benchmark::State& state, const Workload& workload, int threads, Make make) {
  const HeldScans scans(workload, state);
  StageTimes times;
  RunContext context;
  context.threads = threads;
  context.times = &times;
  std::int64_t removed = 0;
  for (auto _ : state) {
    CountingSink sink;
    make()->run(scans, sink, context);
    removed = sink.removed;
  }
  const auto passes = static_cast<double>(state.iterations()) * static_cast<double>(scans.size());
  for (const StageTimes::Stage& stage : times.stages()) {
    state.counters["ms_" + stage.name] = stage.seconds * 1e3 / passes;
  }
  state.counters["removed_points"] = static_cast<double>(removed);
  state.counters["scans_per_iteration"] = static_cast<double>(scans.size());
  state.counters["points_per_scan"] = static_cast<double>(workload.sequence->points) /
                                      static_cast<double>(workload.sequence->scans.size());
}

template <class Run>
benchmark::internal::Benchmark* add(const std::string& name, Run run) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [run](benchmark::State& state) {
                                        try {
                                          run(state);
                                        } catch (const std::exception& error) {
                                          state.SkipWithError(error.what());
                                        }
                                      })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1);
}

}  // namespace

void register_method_kernels() {
  for (const auto& held : workloads()) {
    const Workload& workload = *held;
    if (workload.name == "drive_with_trails") continue;  // The scans are those of the drive.
    for (const int threads : {1, 2}) {
      for (const char* variant : {"online", "offline"}) {
        const auto make = [variant] {
          return MethodRegistry::built_in().configure(std::string("raymoval:") + variant).make();
        };
        add(std::string("raymoval_") + variant + "_" + std::to_string(threads) + "/" +
                workload.name,
            [&workload, threads, make](benchmark::State& state) {
              run_method(state, workload, threads, make);
            });
      }
    }
  }
}

}  // namespace raymoval::kernels_bench
