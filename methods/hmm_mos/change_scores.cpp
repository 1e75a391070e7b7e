// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/change_scores.h"

#include <algorithm>
#include <bit>

namespace raymoval::hmm_mos_method {
namespace {

/// Calls `visit(block, column, bits, shift)` for each column of voxels that a cube around `voxel`
/// cuts: of the column's word, those `bits` are in the cube.
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
  // Into another table: one that something is erased from moves others, and may show them twice.
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
    for_neighbourhood(voxel, [&](const VoxelIndex& neighbour) {
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
    for_neighbourhood(voxel_index(key), [&](const VoxelIndex& voxel) {
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

}  // namespace raymoval::hmm_mos_method
