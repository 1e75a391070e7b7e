// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/layout.h"

namespace raymoval {

/// HeLiMOS ("HeLiMOS: A Dataset for Moving Object Segmentation in 3D Point Clouds From
/// Heterogeneous LiDAR Sensors", 2024): a root with one folder for each sensor, in SemanticKITTI's
/// layout
/// (`Ouster/velodyne`, `Ouster/labels`, `Ouster/calib.txt`), and train.txt, val.txt, test.txt
/// beside them. `ROOT:Ouster` names a sensor, and so does its folder.
///
/// Labels are those of moving-object segmentation: 251 moves, as do SemanticKITTI's moving classes
/// 252 to 259, 9 does not, and 0, which nobody labelled, is ignored. A label rule that the user
/// gives stands above that.
Layout helimos_layout();

}  // namespace raymoval
