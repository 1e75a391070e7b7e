// SPDX-License-Identifier: MIT
// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping", section 3.
// Equation numbers are the order of the numbered equations there.
#include "methods/raymoval/raymoval.h"

#include <algorithm>

#include "core/parallel.h"
#include "methods/common/scan_passes.h"
#include "methods/common/workspaces.h"
#include "methods/raymoval/erase_evidence.h"
#include "methods/raymoval/scan_against_map.h"
#include "methods/raymoval/static_map.h"

namespace raymoval {
namespace {

/// A map and the scans that make it: one that grows from scan to scan, or one of all scans that
/// loses what they see through.
class MapBuilder {
 public:
  MapBuilder(const RaymovalParameters& parameters, const SensorModel& sensor,
             const RunContext& context, const MakeCaster& make_caster)
      : context_(context),
        parameters_(parameters),
        map_(parameters.voxel_size, parameters.permanent_erase),
        test_(parameters, sensor, make_caster),
        evidence_finder_(parameters, sensor, test_.grid()) {}

  [[nodiscard]] StaticMap& map() { return map_; }

  /// Section 3 for one scan and a map that grows.
  /// @return 1 for each point found dynamic now (the online answer)
  Mask process(Scan scan) {
    test_.project_scan(std::move(scan), context_);            // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);         // eqs 4-7
    test_.find_references(map_, context_);                    // eqs 8-9
    const Mask candidates = test_.find_candidates(context_);  // eq. 11
    Mask dynamic;                                             // eqs 12-15
    Evidence evidence;                                        // Of what is seen through.
    side_by_side([&](StageTimes* times) { dynamic = validate(candidates, times); },
                 [&](StageTimes* times) { evidence = find_evidence(times); });
    erase(evidence);
    integrate(dynamic);
    return dynamic;
  }

  /// Adds all points of a scan to the naive map.
  void collect(const Scan& scan) {
    const StageScope timed(context_.times, "integration");
    find_voxels(scan, map_.occupied().inverse_voxel_size(), context_.threads, voxels_);
    VoxelLookup known;
    map_.look_up(voxels_, context_.threads, known);
    map_.integrate(voxels_, known, Mask(voxels_.size(), 0));
  }

  /// Erases what one scan sees through.
  void erase_seen_through(Scan scan) {
    test_.project_scan(std::move(scan), context_);     // eqs 1-3, 10
    test_.cast_first_hits(map_.occupied(), context_);  // eqs 4-7
    test_.find_references(map_, context_);             // eqs 8-9
    erase(find_evidence(context_.times));
  }

 private:
  /// Two steps that only read the map: with several threads one is done beside the other, and they
  /// are timed as one stage.
  template <class Validate, class FindEvidence>
  void side_by_side(Validate&& validate_step, FindEvidence&& evidence_step) {
    const bool together = context_.threads > 1;
    const StageScope timed(together ? context_.times : nullptr, "validation and erase");
    StageTimes* times = together ? nullptr : context_.times;
    parallel_for(context_.threads, 2, 1, [&](std::size_t task) {
      if (task == 0) {
        validate_step(times);
      } else {
        evidence_step(times);
      }
    });
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

  void integrate(const Mask& dynamic) {
    const StageScope timed(context_.times, "integration");
    map_.integrate(test_.voxels(), test_.known(), dynamic);
  }

  const RunContext& context_;
  const RaymovalParameters& parameters_;
  StaticMap map_;
  ScanAgainstMap test_;
  EvidenceFinder evidence_finder_;
  std::vector<VoxelIndex> voxels_;
};

// Codes of `answer_reasons`.
constexpr std::uint8_t kNeverContradicted = 0;
constexpr std::uint8_t kSeenThrough = 1;
constexpr std::uint8_t kInFrontOfMap = 2;
constexpr std::uint8_t kRestored = 3;

std::vector<std::string> answer_reasons() {
  return {"no scan contradicts its voxel, which stays in the map", "a scan saw through its voxel",
          "it stands in front of the map (eq. 11)",
          "it was a candidate, and validation found that it belongs to the static map"};
}

/// A scan's answer, and which points were candidates for it.
struct Answer {
  Mask candidates, dynamic;
};

/// Why each point of a scan is kept or removed, see `answer_reasons`.
std::vector<std::uint8_t> reasons_for(const Answer& answer, const std::vector<VoxelState>& states) {
  std::vector<std::uint8_t> codes(states.size(), kNeverContradicted);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    if (answer.candidates[k] == 0) continue;
    const bool erased = states[k] == VoxelState::kErased;
    codes[k] = answer.dynamic[k] == 0 ? kRestored : erased ? kSeenThrough : kInFrontOfMap;
  }
  return codes;
}

class RaymovalRemover : public Remover {
 public:
  RaymovalRemover(const RaymovalParameters& parameters, const MakeCaster& make_caster)
      : parameters_(parameters), make_caster_(make_caster) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    MapBuilder builder(parameters_, scans.sensor(), context, make_caster_);
    if (!parameters_.offline) {
      run_online(builder, scans, sink, context);
      return;
    }
    if (parameters_.map_source == MapSource::kGrowing) {
      pass_over("raymoval", scans, context, [&](Scan scan) { builder.process(std::move(scan)); });
    } else {
      for_each_scan("raymoval, naive map", scans, context,
                    [&](const Scan& scan) { builder.collect(scan); });
      pass_over("raymoval", scans, context,
                [&](Scan scan) { builder.erase_seen_through(std::move(scan)); });
    }
    answer_from(builder.map(), scans, sink, context);
  }

 private:
  void run_online(MapBuilder& builder, const ScanSource& scans, RemovalSink& sink,
                  const RunContext& context) {
    for_each_scan("raymoval", scans, context, [&](Scan scan) {
      const std::size_t index = scan.index;
      sink.accept(index, builder.process(std::move(scan)));
    });
  }

  /// First to last, and back if there is a backward pass.
  template <class Visit>
  void pass_over(const char* what, const ScanSource& scans, const RunContext& context,
                 Visit&& visit) {
    for_each_scan(what, scans, context, visit);
    if (!parameters_.backward_pass) return;
    for_each_scan("raymoval, backward", scans, context, visit, ScanOrder::kBackward);
  }

  /// Judges every scan by the finished map, as many at a time as there are threads.
  void answer_from(StaticMap& map, const ScanSource& scans, RemovalSink& sink,
                   const RunContext& context) {
    if (context.reasons != nullptr) context.reasons->explain(answer_reasons());
    map.occupied().update_boxes(context.threads);  // From here on the map is only read.
    RunContext own = context;                      // Of one scan among others.
    own.threads = 1;
    if (context.threads > 1) own.times = nullptr;
    Workspaces<ScanAgainstMap> workspaces([&] {
      return std::make_unique<ScanAgainstMap>(parameters_, scans.sensor(), make_caster_);
    });
    const auto answer_scan = [&](Scan& scan) {
      const std::size_t index = scan.index;
      workspaces.with_one([&](ScanAgainstMap& test) {
        const Answer answer = parameters_.map_source == MapSource::kPrior
                                  ? judge(test, std::move(scan), map, own)
                                  : look_up(test, std::move(scan), map, own);
        sink.accept(index, answer.dynamic);
        if (context.reasons == nullptr) return;
        context.reasons->accept(index, reasons_for(answer, test.known().states));
      });
    };
    for_scans_at_once("raymoval, answers", "answer and validation", scans, context, answer_scan);
  }

  /// Section 3 for one scan and the prior map, which is finished.
  Answer judge(ScanAgainstMap& test, Scan scan, StaticMap& prior, const RunContext& context) const {
    test.project_scan(std::move(scan), context);                    // eqs 1-3, 10
    test.cast_first_hits(prior.occupied(), context);                // eqs 4-7
    test.find_references(prior, context);                           // eqs 8-9
    Mask candidates = test.find_candidates(context);                // eq. 11
    return validated(test, std::move(candidates), prior, context);  // eqs 12-15
  }

  /// A point is a candidate iff its voxel is not in the final map.
  Answer look_up(ScanAgainstMap& test, Scan scan, const StaticMap& map,
                 const RunContext& context) const {
    Mask candidates = test.find_off_map(std::move(scan), map, context);
    return validated(test, std::move(candidates), map, context);
  }

  Answer validated(const ScanAgainstMap& test, Mask candidates, const StaticMap& map,
                   const RunContext& context) const {
    const StageScope timed(parameters_.validate ? context.times : nullptr, "validation");
    Mask dynamic = test.validate(candidates, map.occupied());
    return {std::move(candidates), std::move(dynamic)};
  }

  RaymovalParameters parameters_;
  MakeCaster make_caster_;
};

CastImage sweep_caster(const AngularGrid& grid, const RayLimits& limits) {
  return [caster = std::make_shared<FirstHitCaster>(grid, limits)](
             OccupancyMap& map, const Pose& T_world_sensor, int threads, FirstHitImage& image) {
    caster->cast(map, T_world_sensor, threads, image);
  };
}

}  // namespace

std::unique_ptr<Remover> make_raymoval(const RaymovalParameters& parameters,
                                       const MakeCaster& make_caster) {
  if (!parameters.offline && parameters.map_source != MapSource::kGrowing) {
    throw ConfigurationError(
        "raymoval.map_source = prior and naive need all scans, which an online run (offline = "
        "false) does not have; use map_source = growing.");
  }
  return std::make_unique<RaymovalRemover>(parameters, make_caster ? make_caster : sweep_caster);
}

}  // namespace raymoval
