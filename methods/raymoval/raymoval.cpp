// SPDX-License-Identifier: MIT
// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping", section 3.
// Equation numbers are the order of the numbered equations there.
#include "methods/raymoval/raymoval.h"

#include "core/parallel.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
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
      for_each_scan("raymoval, naive map", scans_, context_,
                    [this](const Scan& scan) { integrate_all(scan); });
      pass_over([this](Scan scan) { erase_seen_through(std::move(scan)); });
    }
    return map_;
  }

 private:
  /// Section 3 for one scan and a map that grows.
  /// @return 1 for each point that is dynamic
  Mask process(Scan scan) {
    test_.project_scan(std::move(scan), context_);            // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);         // eqs 4-7
    test_.find_references(map_, context_);                    // eqs 8-9
    const Mask candidates = test_.find_candidates(context_);  // eq. 11
    Mask dynamic;                                             // eqs 12-15
    Evidence evidence;                                        // the erase cases of Fig. 1
    side_by_side([&](StageTimes* times) { dynamic = validate(candidates, times); },
                 [&](StageTimes* times) { evidence = find_evidence(times); });
    erase(evidence);
    integrate(dynamic);
    return dynamic;
  }

  /// The part of section 3 that erases what a scan sees through.
  void erase_seen_through(Scan scan) {
    test_.project_scan(std::move(scan), context_);     // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);  // eqs 4-7
    test_.find_references(map_, context_);             // eqs 8-9
    erase(find_evidence(context_.times));
  }

  Mask validate(const Mask& candidates, StageTimes* times) const {
    const StageScope timed(parameters_.validate ? times : nullptr, "validation");
    return test_.validate(candidates, map_.occupied());
  }

  Evidence find_evidence(StageTimes* times) {
    return evidence_finder_.find(test_, map_.occupied(), context_.threads, times);
  }

  void erase(const Evidence& evidence) {
    for (const VoxelIndex& voxel : evidence.seen_through) map_.erase(voxel);
    for (const VoxelIndex& voxel : evidence.without_return) map_.erase(voxel);
  }

  /// Adds the points of the scan at hand that are not dynamic.
  void integrate(const Mask& dynamic) {
    const StageScope timed(context_.times, "integration");
    map_.integrate(test_.voxels(), test_.known(), dynamic);
  }

  /// Adds all points of a scan.
  void integrate_all(const Scan& scan) {
    const StageScope timed(context_.times, "integration");
    find_voxels(scan, map_.occupied().inverse_voxel_size(), context_.threads, voxels_);
    VoxelLookup known;
    map_.look_up(voxels_, context_.threads, known);
    map_.integrate(voxels_, known, Mask(voxels_.size(), 0));
  }

  /// Takes two steps that only read the map. With several threads one is taken beside the other,
  /// and they are timed as one stage.
  template <class ValidateStep, class EvidenceStep>
  void side_by_side(ValidateStep&& validate_step, EvidenceStep&& evidence_step) {
    const bool together = context_.threads > 1;
    const StageScope timed(together ? context_.times : nullptr, "validation and erase");
    StageTimes* times = together ? nullptr : context_.times;
    parallel_for(context_.threads, 2, 1, [&](std::size_t step) {
      step == 0 ? validate_step(times) : evidence_step(times);
    });
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
  std::vector<VoxelIndex> voxels_;  ///< Of the scan at hand, while the naive map is collected.
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
