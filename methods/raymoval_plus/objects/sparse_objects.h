// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval_plus/evidence/evidence_maps.h"
#include "methods/raymoval_plus/objects/object_summary.h"

namespace raymoval::raymoval_plus_method {

/// Whether an object has far fewer points than a surface as large as its box would have: what hangs
/// together by chance, as drops, flakes or spray, is no thing that can be followed. False where the
/// steps are unknown.
bool is_sparse(const ObjectSummary& object, const DirectionSteps& steps);

}  // namespace raymoval::raymoval_plus_method
