// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "benchmark/clean/rows/map_rows.h"
#include "core/files/replacements.h"
#include "core/scan/scan.h"

namespace raymoval {

/// A scan with the verdict on each of its points.
struct CleanedScan {
  const Scan& scan;
  /// For each point 1 = removed, 0 = kept, `kLeftOutMask` = in no output.
  const Mask& mask;
  const ScanRows& rows;
  const PointRecords* stored;  ///< The records of the scan; null if the sequence has none.
  /// The confidence of each point in steps (`kConfidenceSteps`); empty if there is none.
  std::string_view confidence = {};
};

/// An output of `raymoval clean`. The constructor creates its file or folder under a temporary
/// name, so that a path that cannot be written is found before the work. `commit_with` renames it;
/// without it no file is left behind.
class CleanOutput {
 public:
  CleanOutput() = default;
  virtual ~CleanOutput() = default;
  CleanOutput(const CleanOutput&) = delete;
  CleanOutput& operator=(const CleanOutput&) = delete;

  /// Scans come in order. @throws DataError if the disk is full
  virtual void add(const CleanedScan& scan) = 0;
  /// Writes everything to the disk, so that an error for lack of space occurs here.
  virtual void finish() = 0;
  /// Lets `together` rename the output, after `finish`.
  virtual void commit_with(Replacements& together) = 0;
  /// Number of points of a map after `finish`; 0 for other outputs.
  [[nodiscard]] virtual std::uint64_t points() const { return 0; }
  /// Notes for the user on the written file after `finish`, in sentences.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
};

}  // namespace raymoval
