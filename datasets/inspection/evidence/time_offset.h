// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "datasets/inspection/evidence/samples.h"

namespace raymoval::inspection {

/// A shift of the clock under which the poses move as the scans do.
struct TimeOffset {
  double seconds = 0.0;    ///< To be added to the times of scans, beside what a user says already.
  double deviation = 0.0;  ///< Standard deviation of it, by what the pairs of scans leave open.
  /// Median distance between the motions of poses and scans, as it is and with the shift: metres,
  /// and turns by the way that they move what is 10 m off.
  double given_m = 0.0, shifted_m = 0.0;
  std::size_t pairs = 0;
  /// Pairs whose motion the shift changes by more than what it leaves, and those of them that are
  /// nearer with it.
  std::size_t changed = 0, better = 0;
};

/// Compares the motions that some pairs of scans show with those of the poses at other times. The
/// pairs are those whose motion depends most on the time: where speed or turn rate change.
/// @return the shift, also where it is not far from none. Nothing if the poses do not go by time,
/// or
///   at a steady motion, which is the same at any time.
/// @throws DataError if a scan cannot be read; Cancelled
std::optional<TimeOffset> find_time_offset(Samples& samples);

/// Whether scans and poses are of different times, beyond doubt.
bool is_clear(const TimeOffset& offset);

/// `--time-offset S`, with what a user said already; and what the numbers say.
std::string time_offset_option(const Samples& samples, const TimeOffset& offset);
std::string time_offset_text(const TimeOffset& offset);

/// The pose of a scan with the shift; that which is given where there is none.
Pose pose_with(const Samples& samples, const TimeOffset& offset, std::size_t scan);

}  // namespace raymoval::inspection
