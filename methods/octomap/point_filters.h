// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/octomap_types.h>

#include <vector>

#include "core/scan/scan.h"
#include "methods/octomap/octomap.h"

namespace raymoval::octomap_method {

/// Whether this build has PCL (CMake's RAYMOVAL_PCL), which finds the ground.
inline constexpr bool kHasPcl = RAYMOVAL_PCL;

/// Points on the ground of a scan as the KTH port of OctoMap finds it: one plane by random sample
/// consensus (Fischler and Bolles, 1981; PCL with its fixed seed) whose normal is within
/// `ground_angle` of the z axis, refined by least squares.
/// @param points world axes, metres
/// @return 1 for each point within `ground_distance` of the plane; all 0 for fewer than 50 points
/// or without such a plane
/// @throws ConfigurationError without PCL
Mask find_ground(const std::vector<octomap::point3d>& points, const Parameters& parameters);

/// Statistical outliers (Rusu et al., 2008; as PCL's filter): points whose mean distance to their
/// `noise_neighbours` nearest neighbours is above the scan's mean by more than `noise_sigma`
/// standard deviations. Scans with no more points than that have none.
Mask find_noise(const std::vector<octomap::point3d>& points, const Parameters& parameters,
                int threads);

}  // namespace raymoval::octomap_method
