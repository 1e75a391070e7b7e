// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

/// The protocol of the ERASOR paper, which most papers of the field use: PR, RR and F1 over voxels
/// of the map.
///
/// Truth: all points, cropped, lifted, posed, voxelised scan by scan and once more as a whole, one
/// label per voxel. Estimate: the same of the points that a method kept. Each truth voxel looks for
/// its nearest estimate voxel within half a voxel's diagonal; a static one is preserved if that is
/// static, a moving one remains if that moves. PR = preserved / static, RR = 1 - remaining /
/// moving (percent), F1 their harmonic mean (fraction).
///
/// The intervals of PR, RR and F1 come from a block bootstrap over scans. For this each voxel of
/// the truth belongs to one scan: the scan of the point that gave the voxel its label, which is the
/// point nearest to the centroid. So each voxel counts once, the voxels that several scans saw
/// spread over these scans, and the counts of all scans add up to those of the map.
///
/// Counts: static_voxels, dynamic_voxels, preserved_static, remaining_dynamic; estimate_voxels;
/// estimate_voxels_without_partner (no truth voxel within the same reach; never penalised);
/// mixed_label_ties and estimate_mixed_label_ties (voxels whose class depended on input order);
/// unlabelled_voxels (truth voxels labelled 0 or 1); evaluated_points and removed_points
/// (those of them that were flagged); out_of_range_points, ignored_points, cropped_points. If
/// moving trucks (id 258) occur and move, the first four and the rates come again as `..._no_truck`
/// with trucks counted as static, as in the scripts behind early published tables.
///
/// A cleaned cloud (with `label_mode` nearest, and `lift` 0 unless the cloud was lifted, too)
/// is voxelised once; each voxel takes the label of the nearest point of the dense map, however far
/// away. Static voxels beside removed objects so become dynamic and RR has a ceiling below 100:
/// the score of the oracle's cloud shows it. `cloud_points` then replaces `removed_points`.
ProtocolEntry erasor_protocol_entry();

}  // namespace raymoval
