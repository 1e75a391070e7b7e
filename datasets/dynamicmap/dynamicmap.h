// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "datasets/sequence.h"

namespace raymoval {

/// Opens a sequence of the KTH DynamicMap benchmark: `pcd/NNNNNN.pcd`, points in the world frame,
/// VIEWPOINT = tx ty tz qw qx qy qz = pose of the sensor. `Scan::points` are T^-1 times the stored
/// points.
///
/// Labels: the ground truth of this data set is `gt_cloud.pcd`, a map without scans. The intensity
/// of the scans means different things in different releases (0 / 1 for static / moving, a raw
/// SemanticKITTI label by value, or the strength of the return) and files do not say which, so it
/// is not guessed: intensity is read as label, by value, only where a label rule is given
/// (`labels` in sequence.json or an option, such as {"moving": [1]} for clouds with 0 / 1);
/// otherwise there are no labels. Intensity never becomes reflectance, so that no method can see
/// a label.
Sequence open_dynamicmap(const std::filesystem::path& folder, const SequenceOptions& options);

}  // namespace raymoval
