// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

/// Moving-object segmentation, point by point in each scan, as semantic-kitti-api's evaluate_mos
/// counts it: the intersection over union of the moving class, its precision and its recall.
///
/// A removed point is predicted as moving. With TP the removed moving points, FP the removed static
/// points, and FN the kept moving points,
/// IoU = 100 TP / (TP + FP + FN), precision = 100 TP / (TP + FP), recall = 100 TP / (TP + FN), of
/// the sums over all scans. Points of an ignored label are on neither side. With
/// `ignore_unlabelled`, neither are points of label 0 (unlabelled) and 1 (outlier), unless these
/// labels move by the label rule. The rates do not depend on poses, voxels, or other points.
/// A cleaned cloud keeps the points that lie within 0.05 m of it.
///
/// Counts: static_points, dynamic_points, kept_static_points, flagged_dynamic_points,
/// out_of_range_points, ignored_points. IoU and recall are undefined without a moving point (the
/// public code gives 0), precision if no point is removed. Intervals come from a block bootstrap
/// over scans.
ProtocolEntry mos_protocol_entry();

}  // namespace raymoval
