// SPDX-License-Identifier: MIT
// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping", section 3.
// Equation numbers are the order of the numbered equations there.
#include "methods/raymoval/raymoval.h"

#include <utility>

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/common/side_by_side.h"
#include "methods/raymoval/answers.h"
#include "methods/raymoval/erase_evidence.h"
#include "methods/raymoval/scan_against_map.h"
#include "methods/raymoval/static_map.h"

namespace raymoval::raymoval_method {
namespace {

/// One run: the map, and the scans that make it.
class RaymovalRun {
 public:
  RaymovalRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        context_(context),
        map_(parameters.voxel_size, parameters.permanent_erase),
        test_(parameters, scans.sensor()),
        evidence_finder_(parameters, scans.sensor(), test_.grid()) {}

  /// The online answer: each scan is tested against the map of the scans before it.
  void answer_online(RemovalSink& sink) {
    for_each_scan("raymoval", scans_, context_, [&](Scan scan) {
      const std::size_t index = scan.index;
      sink.accept(index, process(std::move(scan)));
    });
  }

  /// The map from which an offline run answers: one that has grown from scan to scan, or one of all
  /// points that has lost what any scan sees through.
  StaticMap& build_map() {
    if (parameters_.map_source == MapSource::kGrowing) {
      pass_over([this](Scan scan) { process(std::move(scan)); });
    } else {
      collect_all_points();
      pass_over([this](Scan scan) { erase_seen_through(std::move(scan)); });
    }
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
    Evidence evidence;                                        // the erase cases of Fig. 1
    side_by_side(
        context_, "validation and erase",
        [&](const RunContext& context) { dynamic = validate(candidates, context.times); },
        [&](const RunContext& context) { evidence = find_evidence(context); });
    left_over_ = {std::move(evidence), dynamic};
    return dynamic;
  }

  /// The part of section 3 that erases what a scan sees through.
  void erase_seen_through(Scan scan) {
    project(std::move(scan));                              // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);      // eqs 4-7
    test_.find_references(map_, context_, Tests::kErase);  // eqs 8-9
    left_over_ = {find_evidence(context_), {}};
  }

  /// Projects a scan, and beside it brings the map up to date with the scan before, whose answer
  /// did not have to wait for that.
  void project(Scan scan) {
    const Pose pose = scan.T_world_sensor;
    side_by_side(
        context_, "binning and integration",
        [&](const RunContext& context) {
          update_map(context);
          const StageScope timed(context.times, "raycasting");
          test_.prepare_cast(map_.occupied(), pose, context);
        },
        [&](const RunContext& context) { test_.project_next(std::move(scan), context); });
    test_.take_next();
  }

  Mask validate(const Mask& candidates, StageTimes* times) const {
    const StageScope timed(parameters_.validate ? times : nullptr, "validation");
    return test_.validate(candidates, map_.occupied());
  }

  Evidence find_evidence(const RunContext& context) {
    return evidence_finder_.find(test_, map_.occupied(), context.threads, context.times);
  }

  /// Takes out of the map what the scan at hand saw through, and adds its points that are not
  /// dynamic.
  void update_map(const RunContext& context) {
    {
      const StageScope timed(context.times, "integration");
      const LeftOver left_over = std::exchange(left_over_, {});
      for (const VoxelIndex& voxel : left_over.evidence.seen_through) map_.erase(voxel);
      for (const VoxelIndex& voxel : left_over.evidence.without_return) map_.erase(voxel);
      if (!left_over.dynamic.empty()) {
        map_.integrate(test_.voxels().voxels, test_.known(),
                       runs_within(test_.voxels(), left_over.dynamic));
      }
    }
    const StageScope timed(context.times, "raycasting");
    map_.occupied().update_boxes(context.threads);
  }

  /// Makes the naive map: each scan is added to it beside the search for the next one's voxels.
  void collect_all_points() {
    VoxelRuns at_hand, next;
    const auto integrate = [&](const RunContext& context) {
      const StageScope timed(context.times, "integration");
      map_.integrate(at_hand.voxels);
    };
    for_each_scan("raymoval, naive map", scans_, context_, [&](const Scan& scan) {
      side_by_side(context_, "integration", integrate, [&](const RunContext& context) {
        const StageScope timed(context.times, "binning");
        find_voxels(scan, map_.occupied().inverse_voxel_size(), context.threads, next);
      });
      std::swap(at_hand, next);
    });
    integrate(context_);
  }

  /// Visits the scans from the first to the last, and back if a backward pass is asked for.
  template <class Visit>
  void pass_over(Visit&& visit) {
    for_each_scan("raymoval", scans_, context_, visit);
    if (!parameters_.backward_pass) return;
    for_each_scan("raymoval, backward", scans_, all_scans_backward(scans_), context_, visit);
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
  StaticMap map_;
  ScanAgainstMap test_;
  EvidenceFinder evidence_finder_;
  /// What the scan at hand says about the map, until the map has taken it in.
  struct LeftOver {
    Evidence evidence;
    Mask dynamic;  ///< Empty if no points are to be added.
  };
  LeftOver left_over_;
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  RaymovalRun raymoval_run(parameters, scans, context);
  if (parameters.offline) {
    answer_from_map(raymoval_run.build_map(), parameters, scans, sink, context);
  } else {
    raymoval_run.answer_online(sink);
  }
}

}  // namespace

std::unique_ptr<Remover> make_raymoval(const Parameters& parameters) {
  if (!parameters.offline && parameters.map_source != MapSource::kGrowing) {
    throw ConfigurationError(
        "raymoval.map_source = prior and naive need all scans, which an online run (offline = "
        "false) does not have; use map_source = growing.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::raymoval_method
