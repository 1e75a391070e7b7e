// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/peopleremover/bricks.h"

namespace raymoval::peopleremover_method {

/// Step 2.8: clears the voxels of 26-connected components of fewer than `minimum` freed voxels.
/// @param freed one word per brick of `map`
void discard_small_clusters(const BrickMap& map, int minimum, std::vector<BrickWord>& freed);

}  // namespace raymoval::peopleremover_method
