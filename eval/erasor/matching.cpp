// SPDX-License-Identifier: MIT
#include "eval/erasor/matching.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/scan/scan_source.h"
#include "eval/points/cell_neighbours.h"

namespace raymoval::erasor {
namespace {

constexpr std::size_t kGrain = 16384;

/// Nearest voxel of `to` for the voxels [begin, end) of `from`. The reach is half a diagonal, less
/// than a cell's edge, so the 27 cells around hold every candidate.
void find_nearest(const LabelledVoxels& from, const LabelledVoxels& to, double voxel_size,
                  std::size_t begin, std::size_t end, std::vector<std::uint32_t>& partners) {
  CellNeighbours neighbours(to.keys, voxel_size);
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3d& query = from.cloud.points[i];
    double best = matching_bound(voxel_size);
    double reach = std::sqrt(best);
    std::uint32_t partner = kNoPartner;
    neighbours.visit(
        from.keys[i], query, [&] { return reach; },
        [&](std::size_t near) {
          const double squared = (to.cloud.points[near] - query).squaredNorm();
          const auto index = static_cast<std::uint32_t>(near);
          // kNoPartner is the largest index: the bound itself must not win a tie.
          const bool lower = squared == best && partner != kNoPartner && index < partner;
          if (!(squared < best || lower)) return;
          best = squared;
          reach = std::sqrt(squared);
          partner = index;
        });
    partners[i] = partner;
  }
}

std::uint32_t position_of(const std::vector<VoxelKey>& keys, VoxelKey key) {
  const auto found = std::lower_bound(keys.begin(), keys.end(), key);
  if (found == keys.end() || *found != key) return kNoPartner;
  return static_cast<std::uint32_t>(found - keys.begin());
}

bool unlabelled(std::uint32_t word) {
  return semantic_id(word) <= 1;
}

void count_voxel(const LabelledVoxels& truth, const LabelledVoxels& estimate,
                 const std::vector<std::uint32_t>& partners, const LabelClasses& classes,
                 const Options& options, std::size_t i, MatchCounts& counts) {
  const std::uint32_t word = truth.cloud.labels[i];
  const bool moving = classes.moving(word);
  if (options.ignore_0_1 && !moving && unlabelled(word)) return;
  ++(moving ? counts.dynamic_voxels : counts.static_voxels);
  if (partners[i] == kNoPartner) return;
  const bool same_class = classes.moving(estimate.cloud.labels[partners[i]]) == moving;
  if (options.label_rule == LabelRuleOption::kBoth && !same_class) return;
  ++(moving ? counts.remaining_dynamic : counts.preserved_static);
}

}  // namespace

double matching_bound(double voxel_size) {
  // By the inverse, as 1 / 0.2 is exactly 5 and 0.2 is no exact number: 0.2 m gives 0.03.
  const double inverse = 1.0 / voxel_size;
  return 0.75 / (inverse * inverse);
}

std::vector<std::uint32_t> find_partners(const LabelledVoxels& from, const LabelledVoxels& to,
                                         double voxel_size, MatchingOption matching, int threads) {
  std::vector<std::uint32_t> partners(from.size(), kNoPartner);
  if (to.size() == 0) return partners;
  parallel_chunks(threads, from.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    if (matching == MatchingOption::kRadius) {
      find_nearest(from, to, voxel_size, begin, end, partners);
      return;
    }
    for (std::size_t i = begin; i < end; ++i) partners[i] = position_of(to.keys, from.keys[i]);
  });
  return partners;
}

MatchCounts count_matches(const LabelledVoxels& truth, const LabelledVoxels& estimate,
                          const std::vector<std::uint32_t>& partners, const LabelClasses& classes,
                          const Options& options) {
  MatchCounts counts;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    count_voxel(truth, estimate, partners, classes, options, i, counts);
  }
  return counts;
}

std::vector<MatchCounts> count_matches_by_scan(const LabelledVoxels& truth,
                                               const LabelledVoxels& estimate,
                                               const std::vector<std::uint32_t>& partners,
                                               const std::vector<std::uint32_t>& scan_of_voxel,
                                               std::size_t scans, const LabelClasses& classes,
                                               const Options& options) {
  std::vector<MatchCounts> counts(scans);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    count_voxel(truth, estimate, partners, classes, options, i, counts[scan_of_voxel[i]]);
  }
  return counts;
}

}  // namespace raymoval::erasor
