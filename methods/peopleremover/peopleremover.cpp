// SPDX-License-Identifier: MIT
#include "methods/peopleremover/peopleremover.h"

#include <algorithm>
#include <deque>
#include <mutex>

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/common/workspaces.h"
#include "methods/peopleremover/beams.h"
#include "methods/peopleremover/bricks.h"

namespace raymoval::peopleremover_method {
namespace {

/// The used points of a scan (farther than the minimum range), in scan order.
struct LatticeScan {
  Eigen::Vector3d sensor;              ///< Position of the sensor, voxel units.
  std::vector<std::uint32_t> index;    ///< Number of each point in its scan.
  std::vector<Eigen::Vector3d> local;  ///< Sensor frame, metres.
  std::vector<Eigen::Vector3d> world;  ///< World frame, voxel units (metres / voxel size).
  std::vector<VoxelIndex> voxels;      ///< floor(world).
  [[nodiscard]] std::size_t size() const { return index.size(); }
};

/// Step 2.1: drops near points, and places the others on the lattice. Reuses the memory of
/// `result`. @throws DataError if a point lies beyond the lattice.
void put_on_lattice(const Scan& scan, const Parameters& parameters, LatticeScan& result) {
  const double inverse = 1.0 / parameters.voxel_size;
  const double minimum = parameters.effective_minimum_range();
  const Eigen::Vector3d position = scan.T_world_sensor.translation();
  voxel_index(position, inverse);  // Throws if the sensor is beyond the lattice.
  result.sensor = position * inverse;
  result.index.clear();
  result.local.clear();
  result.world.clear();
  result.voxels.clear();
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3d local = scan.points[k].cast<double>();
    if (!(local.squaredNorm() > minimum * minimum)) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * local;
    result.index.push_back(static_cast<std::uint32_t>(k));
    result.local.push_back(local);
    result.world.emplace_back(world * inverse);
    result.voxels.push_back(voxel_index(world, inverse));
  }
}

/// The voxels of one scan as words of a map's bricks; a brick may come more than once.
using OwnVoxels = std::vector<std::pair<BrickId, BrickWord>>;

OwnVoxels own_voxels(const LatticeScan& scan, BrickFinder& finder) {
  OwnVoxels own;
  BrickIndex last = BrickIndex::Constant(kVoxelLimit);
  for (const VoxelIndex& voxel : scan.voxels) {
    const BrickIndex brick = brick_of(voxel);
    if (brick != last) own.emplace_back(finder.find(brick), 0);
    own.back().second |= voxel_bit(voxel);
    last = brick;
  }
  return own;
}

/// The voxels of scan i and of the scans within `diff` of it, for successive i.
class ScanWindow {
 public:
  ScanWindow(const ScanSource& scans, const Parameters& parameters)
      : scans_(scans), parameters_(parameters), diff_(static_cast<std::size_t>(parameters.diff)) {}

  /// Marks the voxels of the window around scan `i`, whose points are `points`.
  void mark(std::size_t i, const LatticeScan& points, BrickFinder& finder, VoxelMarks& marks) {
    marks.clear();
    if (diff_ == 0) {
      set(own_voxels(points, finder), marks);
      return;
    }
    const std::size_t first = i - std::min(i, diff_);
    const std::size_t last = std::min(i + diff_, scans_.size() - 1);
    if (held_.empty()) next_ = first;
    for (; next_ <= last; ++next_) {
      put_on_lattice(scans_.load(next_), parameters_, read_);
      held_.push_back(own_voxels(read_, finder));
    }
    while (held_.size() > last + 1 - first) held_.pop_front();
    for (const OwnVoxels& own : held_) set(own, marks);
  }

 private:
  static void set(const OwnVoxels& own, VoxelMarks& marks) {
    for (const auto& [brick, voxels] : own) marks.set(brick, voxels);
  }

  const ScanSource& scans_;
  const Parameters& parameters_;
  std::size_t diff_;
  std::deque<OwnVoxels> held_;
  std::size_t next_ = 0;
  LatticeScan read_;
};

/// Steps 2.9 and 2.10: the verdicts of a scan from the final freed voxels. Each thread needs its
/// own object.
///
/// half(x) need not be stored: a point of scan i in voxel x is in it iff scan i has a point in a
/// freed voxel near x, which follows from the points of scan i.
class ScanVerdicts {
 public:
  /// @param freed one word per brick of `map`
  ScanVerdicts(const Parameters& parameters, const BrickMap& map,
               const std::vector<BrickWord>& freed)
      : parameters_(parameters),
        freed_(freed),
        finder_(map),
        own_freed_(map.size()),
        halo_(map.size()) {}

  Mask of(const Scan& scan);

 private:
  const Parameters& parameters_;
  const std::vector<BrickWord>& freed_;
  LatticeScan points_;
  BrickFinder finder_;
  VoxelMarks own_freed_;  ///< Freed voxels in which the scan has a point.
  VoxelMarks halo_;       ///< These voxels and all voxels near them.
};

Mask ScanVerdicts::of(const Scan& scan) {
  put_on_lattice(scan, parameters_, points_);
  own_freed_.clear();
  halo_.clear();
  const int radius = parameters_.subvoxel_accuracy ? parameters_.half_voxel_radius : 0;
  for (const VoxelIndex& voxel : points_.voxels) {
    const BrickId brick = finder_.find(brick_of(voxel));
    const BrickWord bit = voxel_bit(voxel);
    if ((freed_[brick] & bit & ~own_freed_.at(brick)) == 0) continue;
    own_freed_.set(brick, bit);
    // Freed voxels of the halo are dynamic anyhow: including them has no effect.
    for_each_brick_near(finder_, voxel, radius,
                        [this](BrickId near, BrickWord voxels) { halo_.set(near, voxels); });
  }
  Mask dynamic(scan.size(), 0);  // Unused points stay static.
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const BrickId brick = finder_.find(brick_of(points_.voxels[k]));
    const BrickWord bit = voxel_bit(points_.voxels[k]);
    dynamic[points_.index[k]] = (halo_.at(brick) & bit) != 0 ? 1 : 0;
  }
  return dynamic;
}

/// The memory of a thread that follows the beams of a scan.
struct BeamWorkspace {
  BeamWorkspace(const Parameters& parameters, const BrickMap& map, FreedVoxels& freed)
      : ends(parameters), finder(map), own(map.size()), walker(map, freed, own) {}
  LatticeScan points;
  BeamEnds ends;
  BrickFinder finder;
  VoxelMarks own;
  BeamWalker walker;
};

/// One run over a sequence. Scans are read again in each step and not held in memory.
class Pass {
 public:
  Pass(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters), scans_(scans), context_(context) {}

  /// Steps 2.1 and 2.2: the voxels that hold a point of any scan.
  BrickMap collect_occupied() {
    CellSet occupied;
    std::mutex mutex;
    Workspaces<LatticeScan> workspaces([] { return std::make_unique<LatticeScan>(); });
    for_chunks("peopleremover, map", 1, workspaces, [&](LatticeScan& points, auto&& each_scan) {
      each_scan([&](const Scan& scan) {
        const StageScope timed(context_.times, "occupancy");
        put_on_lattice(scan, parameters_, points);
        CellSet of_scan;
        for (const VoxelIndex& voxel : points.voxels) of_scan.insert(voxel_key(voxel));
        const std::lock_guard lock(mutex);
        occupied.insert(of_scan);
      });
    });
    const StageScope timed(context_.times, "occupancy");
    return BrickMap(occupied);
  }

  /// Steps 2.3 to 2.7: the voxels that some beam passes through.
  std::vector<BrickWord> free_voxels(const BrickMap& map) {
    FreedVoxels freed(map.size());
    Workspaces<BeamWorkspace> workspaces(
        [&] { return std::make_unique<BeamWorkspace>(parameters_, map, freed); });
    // Consecutive scans share most of their windows.
    const auto diff = static_cast<std::size_t>(parameters_.diff);
    const std::size_t grain = diff == 0 ? 1 : std::max<std::size_t>(8, 4 * diff);
    for_chunks("peopleremover, beams", grain, workspaces,
               [&](BeamWorkspace& work, auto&& each_scan) {
                 ScanWindow window(scans_, parameters_);
                 each_scan([&](const Scan& scan) {
                   put_on_lattice(scan, parameters_, work.points);
                   window.mark(scan.index, work.points, work.finder, work.own);
                   follow_beams(scan, find_ends(work), work);
                 });
               });
    return std::move(freed.words());
  }

  /// Step 2.8.
  void discard_small_clusters(const BrickMap& map, std::vector<BrickWord>& freed) {
    context_.check_cancelled();
    const StageScope timed(context_.times, "clusters");
    peopleremover_method::discard_small_clusters(map, parameters_.min_cluster_size, freed);
  }

  /// Steps 2.9 and 2.10.
  void answer(const BrickMap& map, const std::vector<BrickWord>& freed, RemovalSink& sink) {
    Workspaces<ScanVerdicts> workspaces(
        [&] { return std::make_unique<ScanVerdicts>(parameters_, map, freed); });
    for_chunks("peopleremover, answers", 1, workspaces,
               [&](ScanVerdicts& verdicts, auto&& each_scan) {
                 each_scan([&](const Scan& scan) {
                   const StageScope timed(context_.times, "answer");
                   sink.accept(scan.index, verdicts.of(scan));
                 });
               });
  }

 private:
  /// Visits all scans in chunks of `grain`. `visit_chunk(workspace, each_scan)` has exclusive use
  /// of the workspace, see `for_scan_chunks`.
  template <class Workspace, class VisitChunk>
  void for_chunks(const char* what, std::size_t grain, Workspaces<Workspace>& workspaces,
                  VisitChunk&& visit_chunk) {
    for_scan_chunks(what, scans_, all_scans(scans_), grain, context_, [&](auto&& each_scan) {
      workspaces.with_one([&](Workspace& workspace) { visit_chunk(workspace, each_scan); });
    });
  }

  const std::vector<double>& find_ends(BeamWorkspace& workspace) {
    const StageScope timed(context_.times, "beam ends");
    return workspace.ends.find(workspace.points.local);
  }

  void follow_beams(const Scan& scan, const std::vector<double>& lengths,
                    BeamWorkspace& workspace) {
    const StageScope timed(context_.times, "traversal");
    const LatticeScan& points = workspace.points;
    const double inverse = 1.0 / parameters_.voxel_size;
    constexpr std::size_t kBeamsInTurn = 512;  // Between two checks for a cancel.
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k % kBeamsInTurn == 0) context_.check_cancelled();
      if (lengths[k] == kWholeBeam) {
        workspace.walker.walk(points.sensor, points.world[k]);
        continue;
      }
      const Eigen::Vector3d end = points.local[k] * (lengths[k] / points.local[k].norm());
      workspace.walker.walk(points.sensor, (scan.T_world_sensor * end) * inverse);
    }
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  Pass pass(parameters, scans, context);
  const BrickMap map = pass.collect_occupied();
  std::vector<BrickWord> freed = pass.free_voxels(map);
  pass.discard_small_clusters(map, freed);
  pass.answer(map, freed, sink);
}

}  // namespace

std::unique_ptr<Remover> make_peopleremover(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::peopleremover_method
