// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "methods/raymoval_plus/objects.h"
#include "methods/remover.h"

namespace raymoval {

/// Which of a scan's clusters a track marks, given what tracks need of them all.
using Marking = std::function<std::vector<int>(std::vector<ObjectSummary>)>;

/// Verdicts on a scan whose heights are known: those of its voxels, then of its objects, then of
/// the points below these.
void judge(const EvidenceMap& map, const RaymovalPlusParameters& parameters, const Marking& marking,
           const RunContext& context, WorldScan& world);

}  // namespace raymoval
