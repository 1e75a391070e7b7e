// SPDX-License-Identifier: MIT
// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping", section 3.
// Equation numbers are the order of the numbered equations there.
#include "methods/raymoval/raymoval.h"

#include <utility>

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/common/side_by_side.h"
#include "methods/common/workspaces.h"
#include "methods/raymoval/erase_evidence.h"
#include "methods/raymoval/scan_against_map.h"
#include "methods/raymoval/static_map.h"

namespace raymoval::raymoval_method {
namespace {

/// One run: the map, and the scans that make it.
class RaymovalRun {
 public:
  RaymovalRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : scans_(scans),
        context_(context),
        map_(parameters.voxel_size),
        test_(parameters, scans.sensor()),
        evidence_finder_(parameters, scans.sensor(), test_.grid()) {}

  /// The online result: each scan is tested against the map of the previous scans.
  void answer_online(RemovalSink& sink) {
    for_each_scan("raymoval", scans_, context_, [&](Scan scan) {
      const std::size_t index = scan.index;
      sink.accept(index, process(std::move(scan)));
    });
  }

  /// The prior map of an offline run: all points, without the voxels that any scan sees through.
  StaticMap& build_prior_map() {
    collect_all_points();
    for_each_scan("raymoval", scans_, context_,
                  [this](Scan scan) { erase_seen_through(std::move(scan)); });
    update_map(context_);
    return map_;
  }

 private:
  /// Section 3 for one scan and a map that grows.
  /// @return 1 for each point that is dynamic
  Mask process(Scan scan) {
    project(std::move(scan));                                 // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);         // eqs 4-7
    test_.find_references(map_, context_);                    // eqs 8-9
    const Mask candidates = test_.find_candidates(context_);  // eq. 11
    Mask dynamic;                                             // eqs 12-15
    std::vector<VoxelIndex> seen_through;                     // the erase cases of Fig. 1
    side_by_side(
        context_, "validation and erase",
        [&](const RunContext& context) {
          dynamic = test_.validate(candidates, map_.occupied(), context);
        },
        [&](const RunContext& context) {
          seen_through = evidence_finder_.find(test_, map_.occupied(), context);
        });
    left_over_ = {std::move(seen_through), dynamic};  // Added to the map before the next cast.
    return dynamic;
  }

  /// The part of section 3 that erases the voxels that a scan sees through.
  void erase_seen_through(Scan scan) {
    project(std::move(scan));                              // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);      // eqs 4-7
    test_.find_references(map_, context_, Tests::kErase);  // eqs 8-9
    left_over_ = {evidence_finder_.find(test_, map_.occupied(), context_), {}};
  }

  /// Projects a scan and, in parallel, updates the map with the previous scan. The result of the
  /// previous scan does not need this update.
  void project(Scan scan) {
    side_by_side(
        context_, "binning and integration",
        [&](const RunContext& context) { update_map(context); },
        [&](const RunContext& context) { test_.project_next(std::move(scan), context); });
    test_.take_next();
  }

  /// Removes the voxels that the current scan saw through from the map, and adds the scan's points
  /// that are not dynamic.
  void update_map(const RunContext& context) {
    {
      const StageScope timed(context.times, "integration");
      const LeftOver left_over = std::exchange(left_over_, {});
      for (const VoxelIndex& voxel : left_over.seen_through) map_.erase(voxel);
      if (!left_over.dynamic.empty()) {
        map_.integrate(test_.voxels().voxels, test_.known(),
                       runs_within(test_.voxels(), left_over.dynamic));
      }
    }
    const StageScope timed(context.times, "raycasting");
    map_.occupied().update_boxes(context.threads);
  }

  /// Each scan is added to the map in parallel with the search for the voxels of the next scan.
  void collect_all_points() {
    VoxelRuns at_hand, next;
    const auto integrate = [&](const RunContext& context) {
      const StageScope timed(context.times, "integration");
      map_.integrate(at_hand.voxels);
    };
    for_each_scan("raymoval, all points", scans_, context_, [&](const Scan& scan) {
      side_by_side(context_, "integration", integrate, [&](const RunContext& context) {
        const StageScope timed(context.times, "binning");
        find_voxels(scan, map_.occupied().inverse_voxel_size(), context.threads, next);
      });
      std::swap(at_hand, next);
    });
    integrate(context_);
  }

  const ScanSource& scans_;
  const RunContext& context_;
  StaticMap map_;
  ScanAgainstMap test_;
  EvidenceFinder evidence_finder_;
  /// The update of the map from the current scan that is not done yet.
  struct LeftOver {
    std::vector<VoxelIndex> seen_through;
    Mask dynamic;  ///< Empty if no points are added.
  };
  LeftOver left_over_;
};

/// Why a point is kept or removed: the codes of `ReasonSink`.
enum Reason : std::uint8_t { kNeverContradicted, kSeenThrough, kInFrontOfMap, kRestored };

std::vector<std::string> reason_sentences() {
  return {"no scan contradicts its voxel, which stays in the map", "a scan saw through its voxel",
          "it lies in front of the map (eq. 11)",
          "it was a candidate, and validation found that it belongs to the static map"};
}

std::vector<std::uint8_t> reasons_for(const Mask& candidates, const Mask& dynamic,
                                      const std::vector<VoxelState>& states) {
  std::vector<std::uint8_t> codes(states.size(), kNeverContradicted);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    if (candidates[k] == 0) continue;
    const Reason reason = states[k] == VoxelState::kErased ? kSeenThrough : kInFrontOfMap;
    codes[k] = dynamic[k] == 0 ? kRestored : reason;
  }
  return codes;
}

/// The offline result: tests every scan against the finished map, one scan per thread at a time.
void answer_from_map(StaticMap& map, const Parameters& parameters, const ScanSource& scans,
                     RemovalSink& sink, const RunContext& context) {
  if (context.reasons != nullptr) context.reasons->explain(reason_sentences());
  RunContext of_scan = context;
  of_scan.threads = 1;
  if (context.threads > 1) of_scan.times = nullptr;
  Workspaces<ScanAgainstMap> workspaces(
      [&] { return std::make_unique<ScanAgainstMap>(parameters, scans.sensor()); });
  for_scans_at_once("raymoval, answers", "answer and validation", scans, context, [&](Scan& scan) {
    const std::size_t index = scan.index;
    workspaces.with_one([&](ScanAgainstMap& test) {
      test.project_scan(std::move(scan), of_scan);                              // eqs 1-3, 10
      test.cast_first_hits(map.occupied(), of_scan);                            // eqs 4-7
      test.find_references(map, of_scan, Tests::kForward);                      // eqs 8-9
      const Mask candidates = test.find_candidates(of_scan);                    // eq. 11
      const Mask dynamic = test.validate(candidates, map.occupied(), of_scan);  // eqs 12-15
      sink.accept(index, dynamic);
      if (context.reasons == nullptr) return;
      context.reasons->accept(
          index, reasons_for(candidates, dynamic, test.voxels().of_points(test.known().states)));
    });
  });
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  RaymovalRun raymoval_run(parameters, scans, context);
  if (parameters.offline) {
    answer_from_map(raymoval_run.build_prior_map(), parameters, scans, sink, context);
  } else {
    raymoval_run.answer_online(sink);
  }
}

}  // namespace

std::unique_ptr<Remover> make_raymoval(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::raymoval_method
