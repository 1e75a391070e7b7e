// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// A flat piece of surface in one scan, in the sensor frame.
struct SurfacePatch {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< Metres.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Unit length, towards the sensor.
  double area = 0.0;                                  ///< Square metres, about.
};

/// A point in whole millimetres, with the Morton code of its cell of 256 mm. Sorted by code, the
/// points of each cell of 256 mm times a power of two are contiguous.
struct PlacedPoint {
  std::uint32_t code = 0;
  Eigen::Vector3i at;
};
inline constexpr int kPlacedBits = 8;

/// Calls `visit` with the points of each cell of 2^bits millimetres, bits >= kPlacedBits.
/// @param points sorted by code
template <class Visit>
void for_each_cell(std::span<const PlacedPoint> points, int bits, Visit&& visit) {
  const int shift = 3 * (bits - kPlacedBits);
  for (std::size_t first = 0, i = 1; i <= points.size(); ++i) {
    if (i < points.size() && points[i].code >> shift == points[first].code >> shift) continue;
    visit(points.subspan(first, i - first));
    first = i;
  }
}

using PatchVisit = std::function<void(const SurfacePatch&, std::span<const PlacedPoint>)>;

/// Calls `visit` with each flat patch and its points, among the points of `scan` from `nearest` to
/// `farthest` metres (131 at most) from the sensor. A patch is a cell of 4.1 m whose points lie on
/// a plane; other cells are halved, down to 0.5 m. Sums are of whole millimetres, so the result
/// does not depend on the order of points.
void for_each_patch(const Scan& scan, float nearest, float farthest, const PatchVisit& visit);

}  // namespace raymoval
