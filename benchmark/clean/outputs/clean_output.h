// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/clean/rows/map_rows.h"
#include "core/files/replacements.h"
#include "core/scan/scan.h"

namespace raymoval {

/// A scan, and what became of its points.
struct CleanedScan {
  const Scan& scan;
  /// For each point 1 = removed, 0 = kept, `kLeftOutMask` = in no output.
  const Mask& mask;
  const ScanRows& rows;
  const PointRecords* stored;  ///< The records of the scan; null if the sequence has none.
};

/// Something that `raymoval clean` writes. What it needs on the disk is made by its constructor, so
/// that a place where nothing can be written is found before the work. It gets its name at the end,
/// and leaves nothing behind if that does not come.
class CleanOutput {
 public:
  CleanOutput() = default;
  virtual ~CleanOutput() = default;
  CleanOutput(const CleanOutput&) = delete;
  CleanOutput& operator=(const CleanOutput&) = delete;

  /// Scans come in order. @throws DataError if the disk is full
  virtual void add(const CleanedScan& scan) = 0;
  /// Puts all of it on the disk: what can fail for lack of space has failed after this.
  virtual void finish() = 0;
  /// Lets `together` give it its name, after `finish`.
  virtual void commit_with(Replacements& together) = 0;
  /// Points in it after `finish`, where it is a map; else 0.
  [[nodiscard]] virtual std::uint64_t points() const { return 0; }
  /// What a user should know of what was written after `finish`, in whole sentences.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
};

}  // namespace raymoval
