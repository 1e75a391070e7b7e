// SPDX-License-Identifier: MIT
#include "core/scan/directions.h"

#include <algorithm>
#include <tuple>

namespace raymoval {

Directions::Directions(const Scan& scan) {
  // Two returns of one pulse have the same direction up to the rounding of their coordinates.
  constexpr double kSame = 1e-6, kNearest = 1e-3;
  sorted_.reserve(scan.points.size());
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d p = point.cast<double>();
    const double range = p.norm();
    if (!(range > kNearest)) continue;
    sorted_.push_back(
        {kSame * std::round(std::atan2(p.y(), p.x()) / kSame),
         kSame * std::round(std::asin(std::clamp(p.z() / range, -1.0, 1.0)) / kSame)});
  }
  const auto key = [](const Direction& d) { return std::tie(d.azimuth, d.elevation); };
  std::sort(sorted_.begin(), sorted_.end(),
            [&](const Direction& a, const Direction& b) { return key(a) < key(b); });
  sorted_.erase(
      std::unique(sorted_.begin(), sorted_.end(),
                  [&](const Direction& a, const Direction& b) { return key(a) == key(b); }),
      sorted_.end());
}

std::vector<std::size_t> Directions::sample(std::size_t count) const {
  std::vector<std::size_t> chosen;
  if (count >= sorted_.size()) {
    for (std::size_t i = 0; i < sorted_.size(); ++i) chosen.push_back(i);
    return chosen;
  }
  // Multiples of the golden ratio fall evenly and never in step with the beams of a column.
  constexpr double kGolden = 0.61803398874989484820;
  for (std::size_t k = 1; k <= count; ++k) {
    const double share = static_cast<double>(k) * kGolden;
    const auto at =
        static_cast<std::size_t>((share - std::floor(share)) * static_cast<double>(sorted_.size()));
    chosen.push_back(std::min(at, sorted_.size() - 1));
  }
  return chosen;
}

}  // namespace raymoval
