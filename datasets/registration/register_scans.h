// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/scan.h"
#include "datasets/registration/surface_cloud.h"

namespace raymoval::registration {

/// How well two scans fit under a motion, before and after registration. Metres.
struct Registration {
  Pose T_from_to = Pose::Identity();  ///< Registered.
  std::size_t matched = 0;            ///< Surface points with a counterpart, after registration.
  double overlap = 0.0;  ///< Share of the surface points of `to` on a surface of `from`, 0 to 1.
  double overlap_of_guess = 0.0;  ///< The same under the guess.
  /// Overlaps of the points on surfaces across the way from the guess; 0 if there are few.
  double overlap_across = 0.0, overlap_across_of_guess = 0.0;
  double noise = 0.0;  ///< Robust standard deviation of distances after registration.
  double shift = 0.0;  ///< RMS along the normals by which registration moved the surfaces.
  double shift_of_points = 0.0;  ///< The same in any direction.
};

/// Registers `to` to `from`, starting from a guess of T_from_to with an error of up to about 3 m
/// and 10 degrees. Point to plane (Chen and Medioni 1992), Gauss-Newton with Tukey's weights,
/// counterparts with similar normals only. Motions that the surfaces do not constrain, such as
/// along a tunnel, are not changed. At most 1,500 points of `to` are used.
/// @param others further guesses with an error of up to about 1 m, for scans that may be far off
Registration register_scans(const SurfaceCloud& from, const SurfaceCloud& to, const Pose& guess,
                            const std::vector<Pose>& others = {});

}  // namespace raymoval::registration
