// SPDX-License-Identifier: MIT
#include "methods/raymoval/scan_against_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/raymoval/consistency.h"
#include "methods/raymoval/validation.h"

namespace raymoval::raymoval_method {
namespace {

/// Bins of a step, or `otherwise` where the step is unknown. No sensor of today has finer steps
/// than `most` bins allow; a wrong step then costs no more memory than the finest sensor would.
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
      caster_(grid_, {parameters.minimum_range, parameters.maximum_range}) {
  known_.remembers = true;
}

void ScanAgainstMap::project_scan(Scan scan, const RunContext& context) {
  const StageScope timed(context.times, "binning");
  scan_ = std::move(scan);
  find_voxels(scan_, 1.0 / parameters_.voxel_size, context.threads, voxels_);
  project(scan_, grid_, parameters_.minimum_range, context.threads, projected_);
}

void ScanAgainstMap::cast_first_hits(OccupancyMap& map, const RunContext& context) {
  const StageScope timed(context.times, "raycasting");
  caster_.cast(map, scan_.T_world_sensor, context.threads, first_hit_);
}

void ScanAgainstMap::find_references(const StaticMap& map, const RunContext& context) {
  const StageScope timed(context.times, "classification");
  windowed_percentiles(first_hit_.range, projected_.minimum_range, grid_, parameters_.neighbourhood,
                       {parameters_.percentile, parameters_.erase_percentile}, context.threads,
                       references_);
  map.look_up(voxels_, context.threads, known_);
}

bool ScanAgainstMap::erased_points_are_candidates() const {
  // What may be filled again says nothing for good.
  const bool for_good = parameters_.map_source == MapSource::kPrior || parameters_.permanent_erase;
  return parameters_.erased_points && for_good;
}

Mask ScanAgainstMap::find_candidates(const RunContext& context) const {
  const StageScope timed(context.times, "classification");
  Mask candidates;
  if (parameters_.forward_test) {
    candidates = check_consistency(projected_, references_.first,
                                   {parameters_.tau0, parameters_.tau1}, context.threads);
  } else {
    candidates.assign(scan_.size(), 0);
  }
  if (!erased_points_are_candidates()) return candidates;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    candidates[k] |= known_.states[k] == VoxelState::kErased ? 1 : 0;
  }
  return candidates;
}

Mask ScanAgainstMap::find_off_map(Scan scan, const StaticMap& map, const RunContext& context) {
  const StageScope timed(context.times, "answer");
  scan_ = std::move(scan);
  find_voxels(scan_, 1.0 / parameters_.voxel_size, context.threads, voxels_);
  map.look_up(voxels_, context.threads, known_);
  Mask off(voxels_.size());
  std::transform(known_.states.begin(), known_.states.end(), off.begin(), [](VoxelState state) {
    return static_cast<std::uint8_t>(state == VoxelState::kOccupied ? 0 : 1);
  });
  return off;
}

Mask ScanAgainstMap::validate(const Mask& candidates, const OccupancyMap& static_map) const {
  if (!parameters_.validate) return candidates;
  std::vector<std::size_t> chosen;
  ScanPoints points;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates[k] == 0) continue;
    chosen.push_back(k);
    points.position.push_back(scan_.T_world_sensor * scan_.points[k].cast<double>());
    points.voxel.push_back(voxels_[k]);
    points.range.push_back(scan_.points[k].norm());
  }
  const Mask valid = validate_candidates(points, static_map, parameters_);
  Mask dynamic(candidates.size(), 0);
  for (std::size_t i = 0; i < chosen.size(); ++i) dynamic[chosen[i]] = valid[i];
  return dynamic;
}

}  // namespace raymoval::raymoval_method
