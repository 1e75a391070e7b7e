// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Hashes of what was read of a sequence.
struct LoadedData {
  std::vector<std::string> names;   ///< By scan; empty: not read.
  std::string settings;             ///< Sensor, ranges, label rule and all poses.
  std::vector<std::string> scans;   ///< By scan: time, pose, points, reflectance; empty: not read.
  std::vector<std::string> labels;  ///< By scan: its label words; empty: not read.
  std::string change;               ///< What was read twice and differed; empty: nothing.
};

/// Remembers what is read of a sequence, and notices what has changed when it is read again.
/// Thread-safe.
class LoadRecord {
 public:
  explicit LoadRecord(std::size_t scans);

  /// @throws DataError if this scan, or its labels, were read before and were others
  void note(const Scan& scan);
  void note(const Scan& scan, const std::vector<std::uint32_t>& labels);
  [[nodiscard]] LoadedData data() const;

 private:
  void note(std::vector<std::string>& known, const Scan& scan, const std::string& hash,
            const char* what);

  mutable std::mutex mutex_;
  LoadedData data_;
};

/// A sequence that tells what is read of it.
struct WatchedSequence {
  Sequence sequence;  ///< As given; all that its sources load is noted in `record`.
  std::shared_ptr<LoadRecord> record;

  /// What was read so far. @throws DataError if the sensor has to be estimated and a scan cannot be
  /// read
  [[nodiscard]] LoadedData loaded() const;
};

WatchedSequence watched(Sequence sequence);

/// What of `found` is not as in `expected`, where all was read; empty if all that was read is the
/// same.
std::string changed_data(const LoadedData& expected, const LoadedData& found);

}  // namespace raymoval
