// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "methods/raymoval_plus/objects/tracks.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// The clusters of one scan that the objects of these tracks are, though their own rays do not say
/// so.
std::vector<int> marked_in(std::size_t scan, const std::vector<Track>& tracks,
                           const Parameters& parameters);

/// Step 7: the clusters of each scan that were seen moving before or after, though their own rays
/// do not say so. A track of dynamic objects passes through them, forward or backward in time.
std::vector<std::vector<int>> objects_on_tracks(
    const std::vector<std::vector<ObjectSummary>>& scans, const Parameters& parameters,
    const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
