// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/directions.h"

namespace raymoval {

/// The axis about which the beams of a sensor turn, a unit vector of the frame of the points.
///
/// Neighbouring directions of a beam have the same elevation about this axis. So of all axes, it
/// has the largest share of neighbours that are level. The coordinate axes come first, and an axis
/// within a degree of one of them is that axis. +z always stays +z; another axis points to the side
/// to which fewer beams look, which is up for sensors on vehicles.
///
/// The result does not depend on the order of points. It is +z if there is no such axis (rosettes)
/// or if there are too few directions.
/// @param scans of one sensor
Eigen::Vector3d find_spin_axis(const std::vector<Directions>& scans);

}  // namespace raymoval
