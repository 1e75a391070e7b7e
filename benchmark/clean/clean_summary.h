// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/inspection/evidence/finding.h"
#include "datasets/sequence.h"

namespace raymoval {

/// Looks for mistakes in the data before a map is made of it, as `raymoval inspect` does, and says
/// on standard error what may make the map worse (see `Consequence`).
/// @param path what the user called the sequence, for the message
/// @param force goes on where the map would be wrong, and says so
/// @param context threads, progress and what gives the check up
/// @return the report, whose findings are those in spite of which the map is made
/// @throws DataError with the findings for which it would be wrong; Cancelled
InspectionReport check_data(const Sequence& sequence, const std::string& path, bool force,
                            const OpenContext& context);

/// Warns on standard error if no point was removed, or more than half of them.
void check_removed(std::uint64_t removed, std::uint64_t points, const std::string& path);

/// Counts what was removed by distance from the sensor.
class RangeShares {
 public:
  /// Where the bands of distance begin, metres; the last one has no end.
  static constexpr std::array kBands = {0, 10, 20, 40, 80};

  /// @param mask 1 = removed, 0 = kept; other values do not count
  void add(const Scan& scan, const Mask& mask);
  /// A table with a row for each band that has points.
  [[nodiscard]] std::string table() const;

 private:
  struct Count {
    std::uint64_t points = 0, removed = 0;
  };
  std::array<Count, kBands.size()> counts_;
};

/// What to try if the map does not look right, in whole sentences.
/// @param warned findings about the data in spite of which it was cleaned
/// @param is_seen whether there is a picture or a page of it already
std::vector<std::string> what_to_try(std::uint64_t removed, std::uint64_t points,
                                     const std::string& path, const std::string& method,
                                     const std::vector<Finding>& warned, bool is_seen);

}  // namespace raymoval
