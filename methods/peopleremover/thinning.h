// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::peopleremover_method {

/// Step 2.4, `--reduce X:Y`: which beams of a scan are followed.
struct Thinning {
  int points = 0;      ///< X, at most so many per cell; 0 follows all.
  double angle = 0.0;  ///< Y, radians: a cell has the solid angle of a cap of this half-angle.
  std::uint64_t seed = 0;
};

/// One flag per direction, 1 = followed: of each cell, `points` chosen at random. The choice
/// depends on the seed, the scan and the point's number only.
/// @param points of one scan, sensor frame, none at the origin
std::vector<std::uint8_t> choose_beams(const std::vector<Eigen::Vector3d>& points, std::size_t scan,
                                       const Thinning& thinning);

}  // namespace raymoval::peopleremover_method
