// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/layout.h"

namespace raymoval {

/// Sequences of the KTH DynamicMap benchmark: `pcd/NNNNNN.pcd`, whose points stand in the world
/// frame, and whose VIEWPOINT = tx ty tz qw qx qy qz is the pose of the sensor. `Scan::points` are
/// T^-1 times the stored points.
///
/// The ground truth of this data set is `gt_cloud.pcd`, a map without scans. The intensity
/// of the scans means different things in different releases (0 / 1 for static / moving, a raw
/// SemanticKITTI label by value, or the strength of the return), and the files do not say which.
/// So it is not guessed: intensity is read as a label, by value, only where a label rule is given
/// (`labels` in sequence.json or an option, such as {"moving": [1]} for clouds with 0 / 1);
/// otherwise there are no labels. Intensity never becomes reflectance, so that no method can see
/// a label.
Layout dynamicmap_layout();

}  // namespace raymoval
