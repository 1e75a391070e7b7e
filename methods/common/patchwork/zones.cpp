// SPDX-License-Identifier: MIT
#include "methods/common/patchwork/zones.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace raymoval::patchwork {

ZoneModel::ZoneModel(double from, double to)
    : bounds_{from, (7.0 * from + to) / 8.0, (3.0 * from + to) / 4.0, (from + to) / 2.0, to} {}

int ZoneModel::bin_of(double x, double y) const {
  const double distance = std::sqrt(x * x + y * y);
  if (!(distance >= bounds_.front() && distance <= bounds_.back())) return kNone;
  std::size_t zone = 0;
  int first = 0;
  while (zone + 1 < kRings.size() && distance >= bounds_[zone + 1]) {
    first += kRings[zone] * kSectors[zone];
    ++zone;
  }
  const double width = (bounds_[zone + 1] - bounds_[zone]) / kRings[zone];
  const int ring = static_cast<int>((distance - bounds_[zone]) / width);
  const double angle = std::atan2(y, x);
  const int sector =
      static_cast<int>((angle < 0.0 ? angle + kTurn : angle) / kTurn * kSectors[zone]);
  return first + std::min(ring, kRings[zone] - 1) * kSectors[zone] +
         std::min(sector, kSectors[zone] - 1);
}

int ZoneModel::first_bin(int ring) {
  int first = 0;
  for (std::size_t zone = 0; zone < kRings.size(); ++zone) {
    const int inside = std::min(ring, kRings[zone]);
    first += inside * kSectors[zone];
    ring -= inside;
  }
  return first;
}

int ZoneModel::ring_of(int bin) {
  int ring = 0;
  while (first_bin(ring + 1) <= bin) ++ring;
  return ring;
}

}  // namespace raymoval::patchwork
