// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "eval/erasor/maps/map_voxels.h"
#include "eval/erasor/maps/truth_map.h"
#include "eval/erasor/options.h"

namespace raymoval::erasor {

/// Squared distance below which voxels match: half the diagonal of a voxel, squared, which is
/// 3 s^2 / 4 (0.03 m^2 for 0.2 m). The comparison is strict.
double matching_bound(double voxel_size);

/// The partner of a voxel in a map: the nearest voxel if its squared distance is below
/// `matching_bound`; of several at the same distance it is the one with the lowest key.
/// @param cell in which the voxel is
/// @param mean of the voxel
/// @return its number; `CellLattice::kNone` without a partner
CellLattice::Number find_partner(VoxelKey cell, const Eigen::Vector3d& mean, const MapVoxels& map,
                                 double voxel_size, CellLattice::Cursor& cursor);

/// For each cell of the truth the kind of its voxel's partner, by the options' matching.
std::vector<VoxelKind> partner_kinds(const MapVoxels& truth, const MapVoxels& estimate,
                                     const Options& options, int threads);

/// The overlap in the other direction: partners of the estimate's voxels in the truth.
struct Overlap {
  std::int64_t voxels = 0;           ///< Of the estimate.
  std::int64_t without_partner = 0;  ///< In the truth, by radius.
  std::int64_t near = 0;             ///< With a partner at most half an edge away.

  Overlap& operator+=(const Overlap& other);
};

Overlap overlap_of(const MapVoxels& estimate, const MapVoxels& truth, const Options& options,
                   int threads);

/// The counts that the rates follow from (S, D, Ps and Rd).
struct MatchCounts {
  std::int64_t static_voxels = 0;
  std::int64_t dynamic_voxels = 0;
  std::int64_t preserved_static = 0;
  std::int64_t remaining_dynamic = 0;

  bool operator==(const MatchCounts&) const = default;
};

/// How voxels are counted.
struct CountingRule {
  LabelRuleOption label_rule = LabelRuleOption::kBoth;
  bool ignore_0_1 = false;
  bool trucks_move = true;
};

/// Counts the voxels of the truth by their class and their partners. With the label rule "both" a
/// static voxel is preserved if its partner is static, and a moving one remains if its partner
/// moves. With "geometry" any partner will do.
/// @param partners kind of each truth voxel's partner
MatchCounts count_matches(const TruthMap& truth, const std::vector<VoxelKind>& partners,
                          const CountingRule& rule);

/// The same counts for each scan. @param scans how many there are
std::vector<MatchCounts> count_matches_by_scan(const TruthMap& truth,
                                               const std::vector<VoxelKind>& partners,
                                               std::size_t scans, const CountingRule& rule);

}  // namespace raymoval::erasor
