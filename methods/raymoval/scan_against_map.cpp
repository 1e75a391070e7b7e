// SPDX-License-Identifier: MIT
#include "methods/raymoval/scan_against_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/raymoval/consistency.h"
#include "methods/raymoval/validation.h"

namespace raymoval::raymoval_method {
namespace {

/// Bins of a step, or `otherwise` where the step is unknown. No current sensor has finer steps than
/// `most` bins allow. This limits the memory cost of a wrong step.
int bins_of(double width, double step, int otherwise, double most) {
  constexpr double kFewestBins = 36.0;
  if (!(step > 0.0)) return otherwise;
  return static_cast<int>(std::clamp(std::ceil(width / step), kFewestBins, most));
}

}  // namespace

AngularGrid grid_for(const SensorModel& sensor, const Parameters& parameters) {
  const double margin = parameters.elevation_margin * std::numbers::pi / 180.0;
  AngularGrid grid;
  grid.elevation_min = std::max(sensor.elevation_min - margin, -std::numbers::pi / 2.0);
  grid.elevation_max = std::min(sensor.elevation_max + margin, std::numbers::pi / 2.0);
  constexpr double kMostColumns = 7200.0, kMostRows = 720.0;
  grid.azimuth_bins = parameters.azimuth_bins;
  if (grid.azimuth_bins <= 0) {
    grid.azimuth_bins = bins_of(2.0 * std::numbers::pi, sensor.azimuth_step, 720, kMostColumns);
  }
  grid.elevation_bins = parameters.elevation_bins;
  if (grid.elevation_bins <= 0) {
    grid.elevation_bins =
        bins_of(grid.elevation_max - grid.elevation_min, sensor.elevation_step, 450, kMostRows);
  }
  return grid;
}

ScanAgainstMap::ScanAgainstMap(const Parameters& parameters, const SensorModel& sensor)
    : parameters_(parameters),
      grid_(grid_for(sensor, parameters)),
      caster_(grid_, {parameters.minimum_range, parameters.maximum_range}) {}

void ScanAgainstMap::project_next(Scan scan, const RunContext& context) {
  const StageScope timed(context.times, "binning");
  next_.scan = std::move(scan);
  find_voxels(next_.scan, 1.0 / parameters_.voxel_size, context.threads, next_.voxels);
  project(next_.scan, grid_, parameters_.minimum_range, context.threads, next_.projected);
  // Eq. 8 is needed where the scan has a return.
  next_.wanted.request_around(next_.projected.minimum_range, grid_, parameters_.neighbourhood);
}

void ScanAgainstMap::cast_first_hits(OccupancyMap& map, const RunContext& context) {
  const StageScope timed(context.times, "raycasting");
  caster_.cast(map, at_hand_.scan.T_world_sensor, at_hand_.wanted, context.threads, first_hit_);
}

void ScanAgainstMap::find_references(const StaticMap& map, const RunContext& context, Tests tests) {
  const StageScope timed(context.times, "classification");
  std::array<std::optional<double>, 2> quantiles;
  if (tests != Tests::kErase) quantiles[0] = parameters_.percentile;
  if (tests != Tests::kForward) quantiles[1] = parameters_.erase_percentile;
  windowed_percentiles(first_hit_.range, at_hand_.projected.minimum_range, grid_,
                       parameters_.neighbourhood, quantiles, context.threads, references_);
  map.look_up(at_hand_.voxels.voxels, context.threads, known_);
}

Mask ScanAgainstMap::find_candidates(const RunContext& context) const {
  const StageScope timed(context.times, "classification");
  Mask candidates = check_consistency(at_hand_.projected, references_.first,
                                      {parameters_.tau0, parameters_.tau1}, context.threads);
  for (std::size_t run = 0; run < at_hand_.voxels.size(); ++run) {
    if (known_.states[run] != VoxelState::kErased) continue;
    std::fill(candidates.begin() + at_hand_.voxels.first[run],
              candidates.begin() + at_hand_.voxels.first[run + 1], std::uint8_t{1});
  }
  return candidates;
}

Mask ScanAgainstMap::validate(const Mask& candidates, const OccupancyMap& static_map,
                              const RunContext& context) const {
  if (!parameters_.validate) return candidates;
  const StageScope timed(context.times, "validation");
  std::vector<std::size_t> chosen;
  ScanPoints points;
  for_each_set(candidates, [&](std::size_t k) {
    const Eigen::Vector3d world =
        at_hand_.scan.T_world_sensor * at_hand_.scan.points[k].cast<double>();
    chosen.push_back(k);
    points.position.push_back(world);
    points.voxel.push_back(static_map.voxel_of(world));
    points.range.push_back(at_hand_.scan.points[k].norm());
  });
  const Mask valid = validate_candidates(points, static_map, parameters_);
  Mask dynamic(candidates.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) dynamic[chosen[i]] = valid[i];
  return dynamic;
}

}  // namespace raymoval::raymoval_method
