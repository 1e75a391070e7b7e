// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"
#include "datasets/registration/surface_cloud.h"

namespace raymoval::registration {

/// How well two scans fit under a motion, before and after registration. Metres.
struct Registration {
  Pose T_from_to = Pose::Identity();  ///< Registered.
  std::size_t matched = 0;            ///< Surface points with a counterpart, after registration.
  double overlap = 0.0;  ///< Share of the surface points of `to` on a surface of `from`, 0 to 1.
  double overlap_of_guess = 0.0;  ///< The same under the guess.
  double noise = 0.0;             ///< Robust standard deviation of distances after registration.
  double shift = 0.0;  ///< RMS along the normals by which registration moved the surfaces.
  double shift_of_points = 0.0;  ///< The same in any direction.
};

/// Registers `to` to `from`, starting from a guess of T_from_to with an error of up to about 3 m
/// and 10 degrees. Point to plane (Chen and Medioni 1992), Gauss-Newton with Tukey's weights,
/// counterparts with similar normals only. Motions that the surfaces do not constrain, such as
/// along a tunnel, are not changed. At most 1,500 points of `to` are used.
Registration register_scans(const SurfaceCloud& from, const SurfaceCloud& to, const Pose& guess);

}  // namespace raymoval::registration
