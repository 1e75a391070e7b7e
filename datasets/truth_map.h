// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "datasets/sequence.h"

namespace raymoval {

/// `Sequence::layout` of a map.
inline constexpr const char* kMapLayout = "map";

/// Opens a labelled map as a sequence of one scan, so that protocols score a cleaned map without
/// its original scans. The label of a point is its intensity: 0 or 1 (1 moves), as in the
/// `gt_cloud.pcd` of DynamicMap, or a label of SemanticKITTI, as in ERASOR's maps.
/// @param file in any of the cloud formats, in the frame of the cleaned map
/// @param options name and label rule; others are ignored
/// @throws DataError if the file cannot be read, or an intensity is no label
Sequence open_truth_map(const std::filesystem::path& file, const SequenceOptions& options);

}  // namespace raymoval
