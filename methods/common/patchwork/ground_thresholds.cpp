// SPDX-License-Identifier: MIT
#include "methods/common/patchwork/ground_thresholds.h"

#include <cmath>
#include <numeric>

namespace raymoval::patchwork {
namespace {

// Constants of Patchwork++: how many planes are remembered, and deviations above their mean.
constexpr std::size_t kMostStored = 1000;
constexpr double kElevationDeviations = 2.0, kInnermostElevationDeviations = 3.0;
constexpr double kFlatnessDeviations = 1.0;

void push(std::deque<double>& values, double value) {
  values.push_back(value);
  if (values.size() > kMostStored) values.pop_front();
}

}  // namespace

MeanAndDeviation mean_and_deviation(const std::deque<double>& values) {
  const auto count = static_cast<double>(values.size());
  MeanAndDeviation found;
  found.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - found.mean) * (value - found.mean);
  if (values.size() > 1) found.deviation = std::sqrt(squares / (count - 1.0));
  return found;
}

void GroundThresholds::store(int ring, double elevation, double flatness) {
  push(rings_.at(index(ring)).elevations, elevation);
  push(rings_.at(index(ring)).flatnesses, flatness);
}

void GroundThresholds::adapt() {
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    Ring& ring = rings_[i];
    if (ring.elevations.empty()) continue;
    const MeanAndDeviation elevation = mean_and_deviation(ring.elevations);
    const MeanAndDeviation flatness = mean_and_deviation(ring.flatnesses);
    const double deviations = i == 0 ? kInnermostElevationDeviations : kElevationDeviations;
    ring.elevation = elevation.mean + deviations * elevation.deviation;
    ring.flatness = flatness.mean + kFlatnessDeviations * flatness.deviation;
    if (i == 0) sensor_height_ = -elevation.mean;
  }
}

}  // namespace raymoval::patchwork
