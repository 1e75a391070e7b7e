// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

/// Moving-object segmentation, point by point in each scan, as semantic-kitti-api's evaluate_mos
/// counts it: the intersection over union of the moving class, its precision and its recall.
///
/// A removed point is one that the answer calls moving. With TP the moving points that are removed,
/// FP the static ones that are, and FN the moving ones that are kept,
/// IoU = 100 TP / (TP + FP + FN), precision = 100 TP / (TP + FP), recall = 100 TP / (TP + FN), of
/// the sums over all scans. Points of an ignored label are on neither side, nor are, with
/// `ignore_unlabelled`, those of label 0 (unlabelled) and 1 (outlier), unless these move by the
/// label rule: then they are the classes themselves. Nothing depends on a pose, on a voxel, or on
/// other points.
/// A cleaned cloud keeps the points that lie within 0.05 m of it.
///
/// Counts: static_points, dynamic_points, kept_static_points, flagged_dynamic_points,
/// out_of_range_points, ignored_points. IoU and recall are undefined without a moving point (the
/// public code says 0), precision if no point is removed. Intervals come from a block bootstrap
/// over scans.
ProtocolEntry mos_protocol_entry();

}  // namespace raymoval
