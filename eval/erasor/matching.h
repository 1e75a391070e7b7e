// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "eval/erasor/options.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval::erasor {

inline constexpr std::uint32_t kNoPartner = std::numeric_limits<std::uint32_t>::max();

/// Squared distance below which voxels match: half the diagonal of a voxel, squared, which is
/// 3 s^2 / 4 (0.03 m^2 for 0.2 m). The comparison is strict.
double matching_bound(double voxel_size);

/// Finds for each voxel of `from` its partner in `to`, or `kNoPartner`. By radius the partner is
/// the nearest voxel if its squared distance is below `matching_bound`; of several at the same
/// distance it is the one with the lowest index. By cell it is the voxel of the same cell.
std::vector<std::uint32_t> find_partners(const LabelledVoxels& from, const LabelledVoxels& to,
                                         double voxel_size, MatchingOption matching, int threads);

/// The counts that the rates follow from (S, D, Ps and Rd).
struct MatchCounts {
  std::int64_t static_voxels = 0;
  std::int64_t dynamic_voxels = 0;
  std::int64_t preserved_static = 0;
  std::int64_t remaining_dynamic = 0;

  bool operator==(const MatchCounts&) const = default;
};

/// Counts the voxels of the truth by their class and their partners. With the label rule "both" a
/// static voxel is preserved if its partner is static, and a moving one remains if its partner
/// moves. With "geometry" any partner will do.
/// @param partners of each truth voxel in the estimate
MatchCounts count_matches(const LabelledVoxels& truth, const LabelledVoxels& estimate,
                          const std::vector<std::uint32_t>& partners, const LabelClasses& classes,
                          const Options& options);

/// The same counts for each scan.
/// @param scan_of_voxel scan to which each voxel of the truth belongs, below `scans`
std::vector<MatchCounts> count_matches_by_scan(const LabelledVoxels& truth,
                                               const LabelledVoxels& estimate,
                                               const std::vector<std::uint32_t>& partners,
                                               const std::vector<std::uint32_t>& scan_of_voxel,
                                               std::size_t scans, const LabelClasses& classes,
                                               const Options& options);

}  // namespace raymoval::erasor
