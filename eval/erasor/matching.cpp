// SPDX-License-Identifier: MIT
#include "eval/erasor/matching.h"

#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "eval/lattice/cells_in_reach.h"

namespace raymoval::erasor {
namespace {

constexpr std::size_t kGrain = 1024;  ///< Bricks.

/// The best partner found up to now.
struct Partner {
  double squared;
  CellLattice::Number number = CellLattice::kNone;
  VoxelKey cell = 0;

  void meet(double squared_distance, CellLattice::Number met, VoxelKey met_cell) {
    // The bound itself must not win a tie.
    const bool lower =
        squared_distance == squared && number != CellLattice::kNone && met_cell < cell;
    if (squared_distance < squared || lower) *this = {squared_distance, met, met_cell};
  }
};

bool moves(VoxelKind kind, const CountingRule& rule) {
  return kind == VoxelKind::kMoving || (kind == VoxelKind::kTruck && rule.trucks_move);
}

void count_voxel(VoxelKind truth, VoxelKind partner, const CountingRule& rule,
                 MatchCounts& counts) {
  if (truth == VoxelKind::kNone) return;
  const bool moving = moves(truth, rule);
  if (rule.ignore_0_1 && truth == VoxelKind::kUnlabelled) return;
  ++(moving ? counts.dynamic_voxels : counts.static_voxels);
  if (partner == VoxelKind::kNone) return;
  const bool same_class = moves(partner, rule) == moving;
  if (rule.label_rule == LabelRuleOption::kBoth && !same_class) return;
  ++(moving ? counts.remaining_dynamic : counts.preserved_static);
}

}  // namespace

double matching_bound(double voxel_size) {
  // By the inverse, as 1 / 0.2 is exactly 5 and 0.2 is no exact number: 0.2 m gives 0.03.
  const double inverse = 1.0 / voxel_size;
  return 0.75 / (inverse * inverse);
}

CellLattice::Number find_partner(VoxelKey cell, const Eigen::Vector3d& mean, const MapVoxels& map,
                                 double voxel_size, CellLattice::Cursor& cursor) {
  Partner best{matching_bound(voxel_size)};
  const auto meet = [&](VoxelKey met) {
    const CellLattice::Number number = map.cells().find(met, cursor);
    if (number != CellLattice::kNone) {
      best.meet((map.mean(number) - mean).squaredNorm(), number, met);
    }
  };
  meet(cell);  // First, so that the reach shrinks early.
  const LayerGaps gaps(mean, voxel_index(cell), voxel_size);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const bool is_own = x == 0 && y == 0 && z == 0;
        if (!is_own && gaps.to(x, y, z) <= best.squared) meet(cell_beside(cell, x, y, z));
      }
    }
  }
  return best.number;
}

std::vector<VoxelKind> partner_kinds(const MapVoxels& truth, const MapVoxels& estimate,
                                     const Options& options, int threads) {
  std::vector<VoxelKind> kinds(truth.cells().size(), VoxelKind::kNone);
  const CellLattice& cells = truth.cells();
  parallel_chunks(threads, cells.bricks(), kGrain, [&](std::size_t begin, std::size_t end) {
    CellLattice::Cursor cursor;
    cells.for_each_in(begin, end, [&](CellLattice::Number number, VoxelKey cell) {
      const Eigen::Vector3d mean = truth.mean(number);
      if (!is_voxel(mean)) return;
      const CellLattice::Number partner =
          options.matching == MatchingOption::kSameCell
              ? estimate.cells().find(cell, cursor)
              : find_partner(cell, mean, estimate, options.voxel_size, cursor);
      if (partner != CellLattice::kNone) kinds[number] = estimate.kind(partner);
    });
  });
  return kinds;
}

Overlap& Overlap::operator+=(const Overlap& other) {
  voxels += other.voxels;
  without_partner += other.without_partner;
  near += other.near;
  return *this;
}

Overlap overlap_of(const MapVoxels& estimate, const MapVoxels& truth, const Options& options,
                   int threads) {
  const CellLattice& cells = estimate.cells();
  std::vector<Overlap> parts(cells.bricks() / kGrain + 1);
  parallel_chunks(threads, cells.bricks(), kGrain, [&](std::size_t begin, std::size_t end) {
    CellLattice::Cursor cursor;
    Overlap& part = parts[begin / kGrain];
    cells.for_each_in(begin, end, [&](CellLattice::Number number, VoxelKey cell) {
      const Eigen::Vector3d mean = estimate.mean(number);
      if (!is_voxel(mean)) return;
      ++part.voxels;
      const CellLattice::Number partner =
          find_partner(cell, mean, truth, options.voxel_size, cursor);
      if (partner == CellLattice::kNone) {
        ++part.without_partner;
      } else if ((truth.mean(partner) - mean).norm() <= 0.5 * options.voxel_size) {
        ++part.near;
      }
    });
  });
  Overlap all;
  for (const Overlap& part : parts) all += part;
  return all;
}

MatchCounts count_matches(const TruthMap& truth, const std::vector<VoxelKind>& partners,
                          const CountingRule& rule) {
  MatchCounts counts;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    count_voxel(truth.kind(static_cast<CellLattice::Number>(i)), partners[i], rule, counts);
  }
  return counts;
}

std::vector<MatchCounts> count_matches_by_scan(const TruthMap& truth,
                                               const std::vector<VoxelKind>& partners,
                                               std::size_t scans, const CountingRule& rule) {
  std::vector<MatchCounts> counts(scans);
  for (std::size_t i = 0; i < partners.size(); ++i) {
    const auto number = static_cast<CellLattice::Number>(i);
    count_voxel(truth.kind(number), partners[i], rule, counts[truth.scan(number)]);
  }
  return counts;
}

}  // namespace raymoval::erasor
