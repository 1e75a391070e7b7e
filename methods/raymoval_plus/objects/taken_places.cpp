// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/taken_places.h"

#include <algorithm>

namespace raymoval::raymoval_plus_method {
namespace {

/// A place is filled if along each axis this share of it is.
constexpr double kMostOfIt = 0.5;

}  // namespace

void TakenPlaces::add(std::size_t scan, const ObjectSummary& object) {
  places_.push_back({object.low, object.high, scan});
  longest_ = std::max(longest_, object.high.x() - object.low.x());
}

void TakenPlaces::sort() {
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.low.x() < b.low.x(); });
}

int TakenPlaces::scans_at(const ObjectSummary& object, double slack) const {
  const Eigen::Array3d enough = kMostOfIt * (object.high - object.low).array() - slack;
  const auto begins_before = [](const Place& place, double x) { return place.low.x() < x; };
  const auto first = std::lower_bound(places_.begin(), places_.end(),
                                      object.low.x() - slack - longest_, begins_before);
  const auto end = std::lower_bound(first, places_.end(), object.high.x() + slack, begins_before);
  std::vector<std::size_t> scans;
  for (auto place = first; place != end; ++place) {
    const Eigen::Array3d common =
        place->high.cwiseMin(object.high) - place->low.cwiseMax(object.low);
    if ((common >= enough).all()) scans.push_back(place->scan);
  }
  std::sort(scans.begin(), scans.end());
  return static_cast<int>(std::unique(scans.begin(), scans.end()) - scans.begin());
}

}  // namespace raymoval::raymoval_plus_method
