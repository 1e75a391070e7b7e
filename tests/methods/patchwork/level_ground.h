// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "core/angle.h"
#include "core/scan/scan.h"

namespace raymoval::patchwork_test {

/// A piece of ground: its mean height above the sensor, and how far its points lie above and below.
struct Piece {
  double height = -1.7, roughness = 0.0;
};

/// Points of one sector of the innermost ring of 16: 10 along the radius by 10 across, at the
/// heights of `piece`, in turn above and below, so that they lie level.
inline void add_sector(int sector, const Piece& piece, std::vector<Eigen::Vector3f>& points) {
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) {
      const double radius = 3.0 + 0.4 * i;
      const double azimuth = (sector + 0.05 + 0.1 * k) / 16.0 * kTurn;
      const double z = piece.height + ((i + k) % 2 == 0 ? piece.roughness : -piece.roughness);
      points.emplace_back(
          (Eigen::Vector3d(radius * std::cos(azimuth), radius * std::sin(azimuth), z))
              .cast<float>());
    }
  }
}

/// A scan of the innermost ring, 100 points a sector.
inline Scan ring_scan(const std::function<Piece(int)>& piece) {
  Scan scan;
  for (int sector = 0; sector < 16; ++sector) add_sector(sector, piece(sector), scan.points);
  return scan;
}

/// How many of the points of a sector of such a scan are ground.
inline int ground_of(const Mask& mask, int sector) {
  int ground = 0;
  for (int i = 0; i < 100; ++i) ground += mask[static_cast<std::size_t>(100 * sector + i)];
  return ground;
}

}  // namespace raymoval::patchwork_test
