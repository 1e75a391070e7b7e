// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Points that the files of a sequence hold but that no method gets, counted over the scans that
/// were read so far.
struct LeftOutPoints {
  std::uint64_t stored = 0;       ///< In the files that were read.
  std::uint64_t no_returns = 0;   ///< Of these, not a number or at the sensor.
  std::uint64_t looked_at = 0;    ///< Stored points of the scans that `--drop-ego` looked at.
  std::uint64_t own_vehicle = 0;  ///< Of these, in its region.
};

/// "1 of 60 scans have no return, the first is 000014.pcd; their masks are empty", of the scans
/// that were read so far; empty if each has one.
std::string empty_scans_line(const Sequence& sequence);

/// What was left out of the scans of `sequence` that were read so far.
LeftOutPoints left_out_points(const Sequence& sequence);

/// Lines that tell a user about them: "12.3 % of the stored points are no returns ...". There are
/// none if nothing was left out and the user did not ask for it.
/// @throws DataError if a region had to be found first and a scan cannot be read
std::vector<std::string> left_out_lines(const Sequence& sequence);

/// What of the data is not among the scans of `sequence`, though it was asked for: its damage and
/// losses. Without these scans a score is that of the rest, so a user is warned.
std::vector<std::string> lost_scan_lines(const Sequence& sequence);

/// All that was said when `sequence` was opened: its damage, notes and losses.
std::vector<std::string> opening_lines(const Sequence& sequence);

}  // namespace raymoval
