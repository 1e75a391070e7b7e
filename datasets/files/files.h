// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/layout.h"

namespace raymoval {

/// Plain folders of scans in the sensor frame (any of `cloud_formats`), in natural order of their
/// names, with one pose of the LiDAR for each scan in `poses.txt` or the pose file named (KITTI or
/// TUM rows). Frame numbers are positions in that order, from 0. `labels/NAME.label` is used if
/// there is such a folder. The counts of poses and scans have to be equal.
Layout files_layout();

}  // namespace raymoval
