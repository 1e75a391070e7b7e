// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// A flat piece of surface as one scan sees it, in the sensor frame.
struct SurfacePatch {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< Metres.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit length, towards the sensor.
  double area = 0.0;                                  ///< Square metres, about.
};

/// Flat pieces among the points between 1 m and 30 m from the sensor: cells of 4.1 m whose points
/// lie on a plane, and where they do not, cells of half the size, down to 0.5 m. Sums are made of
/// whole millimetres, so the answer does not depend on the order of points.
std::vector<SurfacePatch> surface_patches(const Scan& scan);

}  // namespace raymoval
