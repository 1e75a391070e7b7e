// SPDX-License-Identifier: MIT
// "DUFOMap: Efficient Dynamic Awareness Mapping"; the steps are numbered in dufomap.h.
#include "methods/dufomap/dufomap.h"

#include <algorithm>
#include <chrono>

#include "core/parallel.h"
#include "methods/dufomap/beams.h"
#include "methods/dufomap/void_map.h"

namespace raymoval {
namespace {

using namespace dufomap;

/// A scan with its part of the work; its memory is used again for later scans.
struct ScanWork {
  Scan scan;
  std::vector<VoxelIndex> voxels;  ///< Of each point.
  ScanGrid grid;
  ScanVoids voids;
  StageTimes times;
};

class DufomapRemover : public Remover {
 public:
  explicit DufomapRemover(const DufomapParameters& parameters) : parameters_(parameters) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    VoidMap voids;
    for_each_batch("dufomap", scans, context, [&](Batch batch) {
      parallel_for(context.threads, batch.count, 1, [&](std::size_t i) { find(batch.work[i]); });
      for (std::size_t i = 0; i < batch.count; ++i) {  // In order of time.
        integrate(batch.work[i], voids);
        if (!parameters_.offline) answer(batch.work[i], voids, sink);
      }
    });
    if (!parameters_.offline) return;
    for_each_batch("dufomap, answers", scans, context, [&](Batch batch) {
      parallel_for(context.threads, batch.count, 1, [&](std::size_t i) {
        batch.work[i].voxels = voxels_of(batch.work[i].scan, parameters_.voxel_size);
        answer(batch.work[i], voids, sink);
      });
    });
  }

 private:
  /// Scans that are worked on at the same time.
  struct Batch {
    std::vector<ScanWork>& work;
    std::size_t count;
  };

  /// Steps 1-4: what one scan says does not depend on any other.
  void find(ScanWork& work) const {
    work.grid.clear();
    std::vector<VoxelIndex> ends;
    {
      const StageScope timed(&work.times, "binning");
      work.voxels = voxels_of(work.scan, parameters_.voxel_size);
      ends = beam_ends(work.scan, work.voxels, parameters_, work.grid);
    }
    {
      const StageScope timed(&work.times, "raycasting");
      cast_beams(work.scan, ends, parameters_, work.grid);
    }
    const StageScope timed(&work.times, "voids");
    find_voids(work.grid, parameters_.unknown_inflation, work.voids);
  }

  /// Step 5, first half.
  static void integrate(ScanWork& work, VoidMap& voids) {
    const StageScope timed(&work.times, "integration");
    voids.add(work.voids);
  }

  /// Step 5, second half.
  static void answer(ScanWork& work, const VoidMap& voids, RemovalSink& sink) {
    const StageScope timed(&work.times, "answer");
    sink.accept(work.scan.index, voids.contain(work.voxels));
  }

  /// Calls `visit` with as many scans at a time as there are threads: the scans of a batch are
  /// independent up to their integration, which goes in order.
  template <class Visit>
  static void for_each_batch(const char* what, const ScanSource& scans, const RunContext& context,
                             Visit&& visit) {
    using Clock = std::chrono::steady_clock;
    context.begin_pass(what, scans.size());
    const auto width = static_cast<std::size_t>(std::clamp(context.threads, 1, 64));
    std::vector<ScanWork> work(std::min(width, scans.size()));
    for (std::size_t first = 0; first < scans.size(); first += width) {
      const std::size_t count = std::min(width, scans.size() - first);
      for (std::size_t i = 0; i < count; ++i) {
        context.check_cancelled();
        work[i].scan = scans.load(first + i);
      }
      const auto started = Clock::now();
      visit(Batch{work, count});
      const std::chrono::duration<double> wall = Clock::now() - started;
      for (std::size_t i = 0; i < count; ++i) {
        if (context.times != nullptr) {
          context.times->add_scan(first + i, wall.count() / static_cast<double>(count));
        }
        context.advance();
      }
    }
    report_stages(work, context);
  }

  /// Stage times of scans worked on side by side, divided by the number of threads at work.
  static void report_stages(const std::vector<ScanWork>& work, const RunContext& context) {
    if (context.times == nullptr) return;
    const double side_by_side = static_cast<double>(work.size());
    for (const ScanWork& one : work) {
      for (const StageTimes::Stage& stage : one.times.stages()) {
        const bool serial = stage.name == "integration";
        context.times->add(stage.name, stage.seconds / (serial ? 1.0 : side_by_side));
      }
    }
  }

  DufomapParameters parameters_;
};

}  // namespace

std::unique_ptr<Remover> make_dufomap(const DufomapParameters& parameters) {
  return std::make_unique<DufomapRemover>(parameters);
}

}  // namespace raymoval
