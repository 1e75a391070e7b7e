// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "eval/erasor/options.h"
#include "eval/protocol.h"

namespace raymoval::erasor {

/// Builds the map of the ground truth, against which masks and clouds are scored.
/// @throws DataError if the map has no voxel
std::unique_ptr<Scorer> make_scorer(const EvaluationInput& input, const Options& options);

}  // namespace raymoval::erasor
