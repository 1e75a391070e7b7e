// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// A shift of the clock under which the motion of the poses matches that of the scans.
struct TimeOffset {
  double seconds = 0.0;    ///< To be added to the times of scans and to the user's offset.
  double deviation = 0.0;  ///< Standard deviation of `seconds`, from the pairs of scans.
  /// Median distance between the motions of poses and scans, without and with the shift: metres,
  /// including rotations times a lever arm of 10 m.
  double given_m = 0.0, shifted_m = 0.0;
  std::size_t pairs = 0;
  /// Number of pairs whose motion the shift changes by more than the remaining distance, and number
  /// of these pairs that are nearer with the shift.
  std::size_t changed = 0, better = 0;
};

/// Compares the motions of some pairs of scans with the motions of the poses at other times. Pairs
/// are chosen where speed or turn rate change, because their motion depends most on the time.
/// @return the shift, which may be near 0. Empty if poses do not have times, or if the motion is
///   steady, which is the same at any time
/// @throws DataError if a scan cannot be read; Cancelled
std::optional<TimeOffset> find_time_offset(Samples& samples);

/// Whether the clocks of scans and poses clearly differ.
bool is_clear(const TimeOffset& offset);

/// `--time-offset S`, including the user's offset, with the evidence.
std::string time_offset_option(const Samples& samples, const TimeOffset& offset);
std::string time_offset_text(const TimeOffset& offset);

/// The pose of a scan with the shift; the given pose if there is none.
Pose pose_with(const Samples& samples, const TimeOffset& offset, std::size_t scan);

}  // namespace raymoval::inspection
