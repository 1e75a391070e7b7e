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

/// Checks the data for mistakes before a map is made of it, as `raymoval inspect` does. Prints on
/// standard error the findings that may make the map worse (see `Consequence`).
/// @param path the sequence as the user wrote it, for messages
/// @param force continues, with a warning, where the map would be wrong
/// @param context threads, progress and cancellation
/// @return the report with the findings that do not stop the map
/// @throws DataError with the findings that would make the map wrong; Cancelled
InspectionReport check_data(const Sequence& sequence, const std::string& path, bool force,
                            const OpenContext& context);

/// Warns on standard error if no point was removed, or more than half of them.
void check_removed(std::uint64_t removed, std::uint64_t points, const std::string& path);

/// Counts removed points by distance from the sensor.
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

/// Suggestions, in sentences, for a map that does not look right.
/// @param warned findings about the data that did not stop the cleaning
/// @param is_seen whether there is already a picture or a page of the map
std::vector<std::string> remedies(std::uint64_t removed, std::uint64_t points,
                                  const std::string& path, const std::string& method,
                                  const std::vector<Finding>& warned, bool is_seen);

}  // namespace raymoval
