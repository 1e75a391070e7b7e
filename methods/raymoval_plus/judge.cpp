// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/judge.h"

namespace raymoval {

void judge(const EvidenceMap& map, const RaymovalPlusParameters& parameters, const Marking& marking,
           const RunContext& context, WorldScan& world) {
  {
    const StageScope timed(context.times, "verdicts");
    take_verdicts(map, parameters, context.threads, world);
  }
  if (parameters.objects) {
    const StageScope timed(context.times, "objects");
    const ScanObjects objects = find_objects(world, map, parameters);
    std::vector<int> marked;
    if (parameters.tracks) marked = marking(summaries(objects, world, map, parameters));
    judge_objects(objects, marked, parameters, world);
  }
  if (parameters.low_points && parameters.terrain) {
    const StageScope timed(context.times, "low points");
    judge_low_points(parameters, world);
  }
}

}  // namespace raymoval
