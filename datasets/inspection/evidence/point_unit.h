// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// Metres of the units that points are taken for.
inline constexpr double kMillimetre = 0.001, kCentimetre = 0.01, kFoot = 0.3048;

/// The share of the best agreement of the scans that the given poses reach if one of the stored
/// points' unit is `unit` metres; 0 if most pairs of scans show too little of the same.
double share_in_unit(const Samples& samples, double unit);

/// Whether a share is that of right poses and a right unit, and `other` that of another unit.
bool tells_unit(double share, double other);

/// If half of the points lie farther away than metres can be, takes them as millimetres or as
/// centimetres: as that under which the scans agree by far better. Where they do not tell,
/// `point_unit_is_open` is set, and the points are taken as millimetres.
void settle_point_unit(Samples& samples);

}  // namespace raymoval::inspection
