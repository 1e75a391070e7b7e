// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "eval/rate.h"

namespace raymoval {

/// How intervals are drawn. The seed is fixed, so the same counts give the same intervals, and all
/// methods on a sequence see the same draws.
struct BootstrapOptions {
  int replicates = 1000;          ///< How many draws.
  double level = 0.95;            ///< The share of draws that an interval holds.
  std::uint64_t seed = 20260101;  ///< Of the draws.
};

/// The interval in which a rate would lie for other scans of the same drive.
struct Interval {
  std::string name;  ///< Of the rate.
  std::optional<double> low, high;
  std::string undefined_reason = "";
};

struct Intervals {
  std::vector<Interval> rates;
  std::size_t scans = 0;
  std::size_t block_scans = 0;
  BootstrapOptions options;
};

/// The number of scans in a block: the square root of the number of all scans, rounded up. This is
/// longer than the cube root, which is best for short correlation, because a place is visible in
/// many scans.
std::size_t bootstrap_block(std::size_t scans);

/// Circular block bootstrap over scans (Politis and Romano, 1992): each replicate strings blocks of
/// consecutive scans with random starts together until it has as many scans as there are, adds
/// their counts up and takes the rates of the sums; the interval holds the middle `level` of the
/// replicates where the rate is defined (nearest rank).
///
/// A protocol that counts voxels assigns each voxel to one scan. Verdicts, map and partners are
/// those of the whole sequence: the interval shows how much the rate depends on the counted scans,
/// not the result of a method with other scans in its map.
/// @param counts_by_scan for each scan in order the same counts
/// @param rates_of the rates that follow from sums of these counts, always the same ones in order
/// @return a rate has no interval if there are fewer than four scans, or if it is undefined in most
/// replicates
Intervals bootstrap(
    const std::vector<std::vector<std::int64_t>>& counts_by_scan,
    const std::function<std::vector<Rate>(const std::vector<std::int64_t>&)>& rates_of,
    const BootstrapOptions& options = {});

}  // namespace raymoval
