// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/moving_voxels.h"

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

namespace raymoval::hmm_mos_method {

namespace {

constexpr int kBins = 100;  ///< Of the histogram of scores; a constant of the public program.

/// Calls `visit(block, column, bits, shift)` for each column that intersects a cube around `voxel`:
/// `bits` of the column's word are in the cube.
template <class Visit>
void for_columns_of_cube(const VoxelIndex& voxel, int reach, Visit&& visit) {
  const int low = voxel.z() - reach, high = voxel.z() + reach;
  for (int x = voxel.x() - reach; x <= voxel.x() + reach; ++x) {
    for (int y = voxel.y() - reach; y <= voxel.y() + reach; ++y) {
      for (int z = low; z <= high;) {
        const int first = z & (kHeight - 1);
        const int count = std::min(high - z + 1, kHeight - first);
        const VoxelIndex at(x, y, z);
        visit(block_of(at), column_of(at), ((std::uint64_t{1} << count) - 1) << first);
        z += count;
      }
    }
  }
}

/// Numbers of voxels by bin. A bin has the scores above its lower edge, up to its upper edge; the
/// first bin also has the lowest score. Edges are compared in whole numbers.
std::vector<std::int64_t> histogram(const std::vector<ScoreCount>& counts, int bins, int lowest,
                                    int highest) {
  std::vector<std::int64_t> voxels(static_cast<std::size_t>(bins));
  const std::int64_t span = highest - lowest;
  for (const ScoreCount& count : counts) {
    const std::int64_t place = std::int64_t{count.score - lowest} * bins;
    const std::int64_t bin = std::max<std::int64_t>((place + span - 1) / span - 1, 0);
    voxels[static_cast<std::size_t>(bin)] += count.voxels;
  }
  return voxels;
}

}  // namespace

Scores change_scores(const ScanGrid& now, const BeliefMap& map, int reach) {
  Scores scores;
  ColumnLookup columns(now);
  for (const VoxelIndex& appeared : map.appeared()) {  // They are few.
    for_columns_of_cube(
        appeared, reach, [&](const VoxelIndex& block, std::size_t column, std::uint64_t bits) {
          for (bits &= columns.column(block, column).hit; bits != 0; bits &= bits - 1) {
            ++scores[voxel_key(voxel_at(block, column, std::countr_zero(bits)))];
          }
        });
  }
  // Into another table: erasing moves other entries of a table, which may then be visited twice.
  Scores positive;
  for (const auto& [key, appeared] : scores) {
    int score = appeared;
    for_columns_of_cube(voxel_index(key), reach,
                        [&](const VoxelIndex& block, std::size_t column, std::uint64_t bits) {
                          score -= std::popcount(bits & ~map.known(block, column));
                        });
    if (score > 0) positive[key] = score;
  }
  return positive;
}

Scores median_scores(const ScanGrid& now, const Scores& scores) {
  ColumnLookup columns(now);
  Scores medians;
  std::vector<int> around;
  const auto median_at = [&](const VoxelIndex& voxel) {
    around.clear();
    for_each_around(voxel, 1, [&](const VoxelIndex& neighbour) {
      if (!columns.is_occupied(neighbour)) return;
      const auto found = scores.find(voxel_key(neighbour));
      around.push_back(found == scores.end() ? 0 : found->second);
    });
    std::sort(around.begin(), around.end());
    const std::size_t middle = around.size() / 2;
    return around.size() % 2 == 1 ? around[middle] : (around[middle - 1] + around[middle]) / 2;
  };
  VoxelSet looked_at;
  for (const auto& [key, score] : scores) {
    for_each_around(voxel_index(key), 1, [&](const VoxelIndex& voxel) {
      if (!columns.is_occupied(voxel) || !looked_at.insert(voxel_key(voxel)).second) return;
      if (const int median = median_at(voxel); median > 0) medians[voxel_key(voxel)] = median;
    });
  }
  return medians;
}

void ScoreWindow::add(Scores scores) {
  for (const auto& [voxel, score] : scores) sums_[voxel] += score;
  last_.push_back(std::move(scores));
  if (last_.size() <= scans_) return;
  for (const auto& [voxel, score] : last_.front()) {
    const auto found = sums_.find(voxel);
    if ((found.value() -= score) == 0) sums_.erase(found);
  }
  last_.pop_front();
}

std::optional<double> otsu_threshold(const std::vector<ScoreCount>& counts, int bins) {
  if (counts.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(
      counts.begin(), counts.end(),
      [](const ScoreCount& a, const ScoreCount& b) { return a.score < b.score; });
  if (low->score == high->score) return std::nullopt;
  const std::vector<std::int64_t> voxels = histogram(counts, bins, low->score, high->score);
  double all = 0.0, all_sum = 0.0;
  for (int i = 0; i < bins; ++i) {
    all += static_cast<double>(voxels[static_cast<std::size_t>(i)]);
    all_sum += i * static_cast<double>(voxels[static_cast<std::size_t>(i)]);
  }
  double below = 0.0, below_sum = 0.0, best = 0.0;
  int threshold = 0;
  for (int i = 0; i < bins; ++i) {  // Bins below i against the rest.
    const double above = all - below;
    if (below > 0.0 && above > 0.0) {
      const double difference = below_sum / below - (all_sum - below_sum) / above;
      const double between = below * above * difference * difference;
      if (between >= best) {
        best = between;
        threshold = i;
      }
    }
    below += static_cast<double>(voxels[static_cast<std::size_t>(i)]);
    below_sum += i * static_cast<double>(voxels[static_cast<std::size_t>(i)]);
  }
  return low->score + static_cast<double>(threshold) * (high->score - low->score) / bins;
}

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
  const std::optional<double> threshold = otsu_threshold(count_scores(now), kBins);
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
    for_each_around(voxel_index(key), 1, [&](const VoxelIndex& voxel) {
      if (columns.is_occupied(voxel)) dynamic_.insert(voxel_key(voxel));
    });
  }
}

}  // namespace raymoval::hmm_mos_method
