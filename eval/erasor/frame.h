// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"

namespace raymoval::erasor {

/// Where ERASOR's own map tool puts a scan: `A P Tr_fixed`, with P the camera pose as the data set
/// gives it, A the turn of camera axes to forward, left, up, and Tr_fixed one calibration for all
/// sequences, that of SemanticKITTI 04 to 12. Where `T_camera_lidar` is that calibration too, this
/// is the sequence's own frame, turned by one rigid motion for all scans; else scans are also
/// displaced against each other (sequences 00 to 02: 0.137 degrees and 5 cm).
/// @param T_world_sensor pose in the sequence's frame, Tr^-1 P Tr
/// @param T_camera_lidar the sequence's own calibration Tr
/// Source: ERASOR, public code, `kitti2node.py`.
Pose erasor_pose(const Pose& T_world_sensor, const Pose& T_camera_lidar);

/// Tr_fixed.
const Pose& fixed_calibration();

}  // namespace raymoval::erasor
