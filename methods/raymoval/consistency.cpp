// SPDX-License-Identifier: MIT
#include "methods/raymoval/consistency.h"

#include <algorithm>
#include <cmath>

namespace raymoval {

Mask check_consistency(const ProjectedScan& scan, const std::vector<float>& map_reference,
                       const RangeMargin& margin) {
  Mask dynamic(scan.range.size(), 0);
  for (std::size_t k = 0; k < dynamic.size(); ++k) {
    if (scan.bin[k] < 0) continue;
    const float reference = map_reference[static_cast<std::size_t>(scan.bin[k])];
    if (reference == kNoRange) continue;
    dynamic[k] = reference - scan.range[k] > margin.at(scan.range[k]) ? 1 : 0;
  }
  return dynamic;
}

double grazing_distance(double vertical, double height, double limit) {
  return std::min(limit, height / std::max(std::abs(vertical), 1e-9));
}

std::vector<int> find_seen_through(const ProjectedScan& scan,
                                   const std::vector<float>& nearest_return,
                                   const FirstHitImage& first_hit,
                                   const std::vector<float>& map_reference,
                                   const RangeMargin& margin) {
  std::vector<int> bins;
  for (std::size_t bin = 0; bin < map_reference.size(); ++bin) {
    if (scan.minimum_range[bin] == kNoRange || first_hit.range[bin] == kNoRange) continue;
    const double reference = map_reference[bin];
    const double seen_to = nearest_return[bin];
    if (seen_to - reference > margin.at(reference) &&
        seen_to - first_hit.range[bin] > margin.tau0) {
      bins.push_back(static_cast<int>(bin));
    }
  }
  return bins;
}

std::vector<int> find_no_return(const std::vector<float>& nearest_return,
                                const FirstHitImage& first_hit, const AngularGrid& grid,
                                const SensorModel& sensor, double maximum_range) {
  std::vector<int> bins;
  for (std::size_t bin = 0; bin < nearest_return.size(); ++bin) {
    const int number = static_cast<int>(bin);
    if (nearest_return[bin] != kNoRange || !(first_hit.range[bin] <= maximum_range)) continue;
    const double azimuth = grid.azimuth_centre(grid.azimuth_of(number));
    const double elevation = grid.elevation_centre(grid.elevation_of(number));
    const bool in_view = azimuth >= sensor.azimuth_min && azimuth <= sensor.azimuth_max &&
                         elevation >= sensor.elevation_min && elevation <= sensor.elevation_max;
    if (in_view) bins.push_back(number);
  }
  return bins;
}

}  // namespace raymoval
