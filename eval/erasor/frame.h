// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"

namespace raymoval::erasor {

/// The pose of a scan in ERASOR's map tool: `A P Tr_fixed`, with P the camera pose of the data set,
/// A the rotation of camera axes to forward, left, up, and Tr_fixed one calibration for all
/// sequences, that of SemanticKITTI 04 to 12. If `T_camera_lidar` is this calibration, all scans
/// move by one rigid motion. Else scans are also displaced relative to each other (sequences 00 to
/// 02: 0.137 degrees and 5 cm).
/// @param T_world_sensor pose in the sequence's frame, Tr^-1 P Tr
/// @param T_camera_lidar the sequence's own calibration Tr
/// Source: ERASOR, public code, `kitti2node.py`.
Pose erasor_pose(const Pose& T_world_sensor, const Pose& T_camera_lidar);

/// Tr_fixed.
const Pose& fixed_calibration();

}  // namespace raymoval::erasor
