// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/moving_voxels.h"

#include <bit>
#include <map>

namespace raymoval::hmm_mos_method {

void MovingVoxels::add(const ScanGrid& now, const BeliefMap& map) {
  // The first scans only fill the map.
  const bool is_scored = scans_++ > parameters_.window_scans;
  window_.add(is_scored ? median_scores(now, change_scores(now, map, parameters_.reach))
                        : Scores());
  find_dynamic(now);
}

std::vector<ScoreCount> MovingVoxels::count_scores(const ScanGrid& now) const {
  std::int64_t occupied = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    for (const Column& column : now[i].columns) occupied += std::popcount(column.hit);
  }
  ColumnLookup columns(now);
  std::map<int, std::int64_t> voxels;
  for (const auto& [key, sum] : window_.sums()) {
    if (!columns.is_occupied(voxel_index(key))) continue;
    ++voxels[sum];
    --occupied;
  }
  if (occupied > 0) voxels[0] = occupied;
  std::vector<ScoreCount> counts;
  for (const auto& [score, count] : voxels) counts.push_back({score, count});
  return counts;
}

void MovingVoxels::find_dynamic(const ScanGrid& now) {
  const std::optional<double> threshold = otsu_threshold(count_scores(now), parameters_.bins);
  is_static_ = !threshold || *threshold <= parameters_.least_threshold;
  ColumnLookup columns(now);
  VoxelSet seeds;
  for (const auto& [key, sum] : window_.sums()) {  // Steps 9 and 10.
    const bool is_above = threshold && sum > *threshold;
    const bool stays = sum > parameters_.least_threshold && dynamic_.contains(key);
    if ((is_above || stays) && columns.is_occupied(voxel_index(key))) seeds.insert(key);
  }
  dynamic_.clear();
  for (const VoxelKey key : seeds) {  // Step 11.
    for_neighbourhood(voxel_index(key), [&](const VoxelIndex& voxel) {
      if (columns.is_occupied(voxel)) dynamic_.insert(voxel_key(voxel));
    });
  }
}

}  // namespace raymoval::hmm_mos_method
