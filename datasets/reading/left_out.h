// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// Points of a sequence that its files hold and nobody gets, over the scans that were read so far.
struct LeftOutPoints {
  std::uint64_t stored = 0;       ///< In the files that were read.
  std::uint64_t no_returns = 0;   ///< Of these, not a number or at the sensor.
  std::uint64_t looked_at = 0;    ///< Stored points of the scans that `--drop-ego` looked at.
  std::uint64_t own_vehicle = 0;  ///< Of these, in its region.
};

/// Adds up what is left out of each scan, however often and by whichever thread it is read.
class LeftOutTally {
 public:
  explicit LeftOutTally(std::size_t scans) : scans_(scans) {}
  void set(std::size_t scan, std::uint64_t stored, std::uint64_t left_out) const;
  /// Stored and left out points of all scans that were set.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> total() const;

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<std::uint64_t, std::uint64_t>> scans_;
};

struct Sequence;

/// What was left out of the scans of `sequence` that were read so far.
LeftOutPoints left_out_points(const Sequence& sequence);

/// What a user should know of it, a line each: "12.3 % of the stored points are no returns ...".
/// Empty if nothing was left out and nothing was asked to be.
/// @throws DataError if a region had to be found first and a scan cannot be read
std::vector<std::string> left_out_lines(const Sequence& sequence);

}  // namespace raymoval
