// SPDX-License-Identifier: MIT
// The whole scan loop, the same with dense walks instead of the sweep, and the upkeep of its map.
#include <benchmark/benchmark.h>

#include "benchmark/kernels/ray_designs.h"
#include "benchmark/kernels/registration.h"
#include "benchmark/kernels/workloads.h"
#include "methods/raymoval/raymoval.h"
#include "methods/raymoval/static_map.h"
#include "methods/registry.h"

namespace raymoval::kernels_bench {
namespace {

constexpr std::size_t kScans = 60;

/// Scans held in memory: neither reading nor copying them is measured.
class HeldScans : public ScanSource {
 public:
  HeldScans(const Workload& workload, benchmark::State* state)
      : sequence_(*workload.sequence), state_(state) {}
  [[nodiscard]] std::size_t size() const override {
    return std::min(sequence_.scans.size(), kScans);
  }
  [[nodiscard]] Scan load(std::size_t i) const override {
    if (state_ != nullptr) state_->PauseTiming();
    Scan scan = sequence_.scans[i];
    scan.index = i;
    if (state_ != nullptr) state_->ResumeTiming();
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t i) const override {
    return sequence_.scans[i].T_world_sensor;
  }
  [[nodiscard]] const SensorModel& sensor() const override { return sequence_.sensor; }

 private:
  const HeldSequence& sequence_;
  benchmark::State* state_;
};

class CountingSink : public RemovalSink {
 public:
  void accept(std::size_t, const Mask& mask) override {
    removed += std::count(mask.begin(), mask.end(), 1);
  }
  std::int64_t removed = 0;
};

void count_scans(benchmark::State& state, const Workload& workload, const HeldScans& scans) {
  state.counters["scans_per_iteration"] = static_cast<double>(scans.size());
  state.counters["points_per_scan"] = static_cast<double>(workload.sequence->points) /
                                      static_cast<double>(workload.sequence->scans.size());
}

/// One iteration is a pass over the scans.
template <class Make>
void run_method(benchmark::State& state, const Workload& workload, int threads, Make make) {
  const HeldScans scans(workload, &state);
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
  count_scans(state, workload, scans);
}

RaymovalParameters online_parameters() {
  return raymoval_parameter_table().read(
      MethodRegistry::built_in().configure("raymoval:online").configuration);
}

/// Dense walks on a block of bits that is made anew for each scan; making it is not measured.
MakeCaster dense_caster(benchmark::State& state) {
  return [&state](const AngularGrid& grid, const RayLimits& limits) -> CastImage {
    const auto directions = std::make_shared<const DirectionTable>(grid);
    return [&state, grid, limits, directions](OccupancyMap& map, const Pose& T_world_sensor, int,
                                              FirstHitImage& image) {
      image.grid = grid;
      image.T_world_sensor = T_world_sensor;
      image.limits = limits;
      image.directions = directions;
      image.range.assign(static_cast<std::size_t>(grid.size()), kNoRange);
      if (map.size() == 0) return;
      state.PauseTiming();
      const DenseBits bits(map);
      state.ResumeTiming();
      dense_bitset_dda(bits, {&image, &image.range, nullptr});
    };
  };
}

/// What one scan did to the map.
struct MapChange {
  Mask dynamic;
  std::vector<VoxelIndex> erased;
};

/// Watches the map between scans.
class ChangeRecorder : public RemovalSink {
 public:
  void accept(std::size_t scan, const Mask& mask) override {
    changes.resize(std::max(changes.size(), scan + 1));
    changes[scan].dynamic = mask;
  }
  /// Books what has gone from the map since the last call to the last scan.
  void look_at(const OccupancyMap& map) {
    if (!changes.empty()) {
      for_voxels_gone(map,
                      [&](const VoxelIndex& voxel) { changes.back().erased.push_back(voxel); });
    }
    before_.clear();
    for (OccupancyMap::Slot slot = 0; slot < map.brick_count(); ++slot) {
      before_.push_back(map.brick(slot));
    }
  }
  std::vector<MapChange> changes;

 private:
  template <class Visit>
  void for_voxels_gone(const OccupancyMap& map, Visit&& visit) const {
    for (std::size_t tile = 0; tile < map.tile_count(); ++tile) {
      for (const OccupancyMap::BrickHead& head : map.tile(tile)) {
        if (head.slot >= before_.size()) continue;
        const Brick& now = map.brick(head.slot);
        if (now.occupied == before_[head.slot].occupied) continue;
        const VoxelIndex low(head.at[0] * 8, head.at[1] * 8, head.at[2] * 8);
        for (int k = 0; k < 512; ++k) {
          const VoxelIndex voxel = low + VoxelIndex(k >> 6, k >> 3 & 7, k & 7);
          if (before_[head.slot].contains(voxel.x(), voxel.y(), voxel.z()) &&
              !now.contains(voxel.x(), voxel.y(), voxel.z())) {
            visit(voxel);
          }
        }
      }
    }
  }
  std::vector<Brick> before_;
};

/// The changes that raymoval:online makes to its map, scan by scan.
std::vector<MapChange> changes_of(const HeldScans& scans) {
  ChangeRecorder recorder;
  const MakeCaster make = [&](const AngularGrid& grid, const RayLimits& limits) -> CastImage {
    const auto caster = std::make_shared<FirstHitCaster>(grid, limits);
    return [&recorder, caster](OccupancyMap& map, const Pose& pose, int threads,
                               FirstHitImage& image) {
      recorder.look_at(map);
      caster->cast(map, pose, threads, image);
    };
  };
  make_raymoval(online_parameters(), make)->run(scans, recorder, {});
  return recorder.changes;
}

/// The same changes again and nothing else: looking the scan's voxels up, erasing what was seen
/// through, inserting what is new and mending the boxes of the bricks that changed. One iteration
/// is all scans. The last scan's erasures are not known and left out.
void map_upkeep(benchmark::State& state, const Workload& workload) {
  const HeldScans scans(workload, nullptr);
  const std::vector<MapChange> changes = changes_of(scans);
  const RaymovalParameters parameters = online_parameters();
  std::vector<std::vector<VoxelIndex>> voxels(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    find_voxels(scans.load(i), 1.0 / parameters.voxel_size, 1, voxels[i]);
  }
  std::size_t erased = 0, held = 0;
  for (const MapChange& change : changes) erased += change.erased.size();
  VoxelLookup known;
  for (auto _ : state) {
    StaticMap map(parameters.voxel_size, parameters.permanent_erase);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      map.occupied().update_boxes(1);
      state.PauseTiming();
      map.look_up(voxels[i], 1, known);
      state.ResumeTiming();
      for (const VoxelIndex& voxel : changes[i].erased) map.erase(voxel);
      map.integrate(voxels[i], known, changes[i].dynamic);
    }
    held = map.occupied().size();
  }
  count_scans(state, workload, scans);
  const auto count = static_cast<double>(scans.size());
  state.counters["erased_per_scan"] = static_cast<double>(erased) / count;
  state.counters["inserted_per_scan"] = static_cast<double>(held + erased) / count;
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
    add("raymoval_online_map_upkeep/" + workload.name,
        [&workload](benchmark::State& state) { map_upkeep(state, workload); });
    if (held != workloads().front()) continue;  // It takes long, and one sequence will do.
    add("raymoval_online_with_dense_dda/" + workload.name, [&workload](benchmark::State& state) {
      run_method(state, workload, 1,
                 [&] { return make_raymoval(online_parameters(), dense_caster(state)); });
    });
  }
}

}  // namespace raymoval::kernels_bench
