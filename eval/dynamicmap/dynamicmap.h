// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

/// The protocol of the KTH DynamicMap benchmark: SA, DA, AA, HA over the points of all scans.
///
/// Truth: every point, where the poses put it, without voxels, crop or lift. A point is present if
/// any kept point, itself included, is at most `distance` away, else it is gone; labels of kept
/// points are ignored. SA = present static / static, DA = gone dynamic / dynamic (percent), AA =
/// sqrt(SA DA), HA = 2 SA DA / (SA + DA). Their intervals come from a block bootstrap over scans;
/// each point belongs to its scan. So a removed point that lies near a kept one counts as present,
/// and an oracle stays below DA 100 where wheels touch the road. Points of an ignored label are in
/// neither denominator, but a map made by a method holds them like any other
/// (`ignored_in_estimate`).
///
/// Counts: static_points, dynamic_points, present_static_points, removed_dynamic_points; by index,
/// directly from the masks: kept_static_points, flagged_dynamic_points; ego_points (among the
/// dynamic ones), out_of_range_points, ignored_points. Undefined without a static or a dynamic
/// point; an empty estimate scores SA 0 and DA 100 (the public code leaves it at 100 and 100).
///
/// @note Distances are computed in double from float32 sensor coordinates, not in float32 as by the
/// public code: a difference of rounding only, which does not depend on the distance of the origin.
ProtocolEntry dynamicmap_protocol_entry();

}  // namespace raymoval
