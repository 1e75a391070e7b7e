// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/judge.h"

namespace raymoval {
namespace {

/// Why the verdicts are what the map says.
void note_reasons(const EvidenceMap& map, WorldScan& world) {
  for (std::size_t k = 0; k < world.verdict.size(); ++k) {
    Reason reason = Reason::kGround;
    if (const std::uint32_t voxel = world.voxel[k]; voxel != EvidenceMap::kNone) {
      const bool seen_through = map.decision(voxel) == Evidence::kDynamic;
      const bool removed = world.verdict[k] == Evidence::kDynamic;
      reason = seen_through ? (removed ? Reason::kSeenThrough : Reason::kNeighboursKeep)
                            : (removed ? Reason::kNeighboursRemove : Reason::kNothingSeen);
    }
    world.reason[k] = static_cast<std::uint8_t>(reason);
  }
}

/// Calls `change()`, and notes the reasons of the verdicts that it changes.
template <class Change>
void noting(Reason removed, Reason kept, WorldScan& world, Change&& change) {
  const std::vector<Evidence> before =
      world.reason.empty() ? std::vector<Evidence>{} : world.verdict;
  change();
  for (std::size_t k = 0; k < before.size(); ++k) {
    const bool is = world.verdict[k] == Evidence::kDynamic;
    if (is == (before[k] == Evidence::kDynamic)) continue;
    world.reason[k] = static_cast<std::uint8_t>(is ? removed : kept);
  }
}

}  // namespace

void judge(const EvidenceMap& map, const RaymovalPlusParameters& parameters, const Marking& marking,
           const RunContext& context, WorldScan& world) {
  {
    const StageScope timed(context.times, "verdicts");
    take_verdicts(map, parameters, context.threads, world);
  }
  if (context.reasons != nullptr) {
    world.reason.resize(world.verdict.size());
    note_reasons(map, world);
  }
  if (parameters.objects) {
    const StageScope timed(context.times, "objects");
    const ScanObjects objects = find_objects(world, map, parameters);
    std::vector<int> marked;
    if (parameters.tracks) marked = marking(summaries(objects, world, map, parameters));
    noting(Reason::kObjectRemoved, Reason::kObjectKept, world,
           [&] { judge_objects(objects, marked, parameters, world); });
  }
  if (parameters.low_points && parameters.terrain) {
    const StageScope timed(context.times, "low points");
    noting(Reason::kStandsOnRemoved, Reason::kStandsOnKept, world,
           [&] { judge_low_points(parameters, world); });
  }
}

}  // namespace raymoval
