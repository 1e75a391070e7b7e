// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Stored points of a sequence that no method gets, counted over the scans that were read.
struct LeftOutPoints {
  std::uint64_t stored = 0;       ///< In the files that were read.
  std::uint64_t no_returns = 0;   ///< Stored points that are not a number or at the sensor.
  std::uint64_t looked_at = 0;    ///< Stored points of the scans that `--drop-ego` checked.
  std::uint64_t ego_vehicle = 0;  ///< Of `looked_at`, in the region of the ego vehicle.
};

/// "1 of 60 scans have no return, the first is 000014.pcd; their masks are empty", of the scans
/// that were read; empty if each scan has a return.
std::string empty_scans_line(const Sequence& sequence);

/// The points that were left out of the scans of `sequence` that were read.
LeftOutPoints left_out_points(const Sequence& sequence);

/// Lines on left out points for the user: "12.3 % of the stored points are no returns ...". There
/// are none if no point was left out and the user gave no region.
/// @throws DataError if the region must be estimated first and a scan cannot be read
std::vector<std::string> left_out_lines(const Sequence& sequence);

/// Requested data that is missing in `sequence`: its damage and losses. Scores do not cover the
/// missing scans, so the user is warned.
std::vector<std::string> lost_scan_lines(const Sequence& sequence);

/// All messages about opening `sequence`: its damage, notes and losses.
std::vector<std::string> opening_lines(const Sequence& sequence);

}  // namespace raymoval
