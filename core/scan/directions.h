// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/angle.h"
#include "core/scan/scan.h"

namespace raymoval {

/// A direction of the sensor frame, radians.
struct Direction {
  double azimuth = 0.0;    ///< -pi to pi, counter-clockwise from +x about +z.
  double elevation = 0.0;  ///< -pi/2 to pi/2, up from the x-y plane.
};

/// The directions in which a scan has returns, sorted by azimuth. It is a set: neither the order of
/// the points nor a second return of one direction changes it.
class Directions {
 public:
  /// Points at the origin have no direction and are left out.
  explicit Directions(const Scan& scan);

  [[nodiscard]] std::size_t size() const { return sorted_.size(); }
  [[nodiscard]] const Direction& operator[](std::size_t i) const { return sorted_[i]; }

  /// Some directions, spread evenly over the scan; the same ones for the same set.
  [[nodiscard]] std::vector<std::size_t> sample(std::size_t count) const;

  /// Calls `visit(azimuth, elevation)`, both relative to direction `i`, for all directions whose
  /// azimuth is larger by at most `reach` radians, across +-pi too.
  template <class Visit>
  void visit_ahead(std::size_t i, double reach, Visit&& visit) const {
    walk(i, reach, 1, visit);
  }
  /// The same for directions on either side.
  template <class Visit>
  void visit_around(std::size_t i, double reach, Visit&& visit) const {
    walk(i, reach, 1, visit);
    walk(i, reach, -1, visit);
  }

 private:
  template <class Visit>
  void walk(std::size_t i, double reach, int step, Visit& visit) const {
    const std::size_t count = sorted_.size();
    std::size_t j = i;
    for (std::size_t steps = 1; steps < count; ++steps) {
      j = step > 0 ? (j + 1 == count ? 0 : j + 1) : (j == 0 ? count - 1 : j - 1);
      double azimuth = sorted_[j].azimuth - sorted_[i].azimuth;
      if (step * azimuth < 0.0) azimuth += step * kTurn;
      if (std::abs(azimuth) > reach) return;
      visit(azimuth, sorted_[j].elevation - sorted_[i].elevation);
    }
  }

  std::vector<Direction> sorted_;
};

}  // namespace raymoval
