// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Hashes of the data that was read of a sequence.
struct LoadedData {
  std::vector<std::string> names;  ///< Of each scan; empty for a scan that was not read.
  std::string settings;            ///< Sensor, ranges, label rule and all poses.
  std::vector<std::string>
      scans;  ///< Of each scan: time, pose, points, reflectance; empty if not read.
  std::vector<std::string> labels;  ///< Of each scan: its label words; empty if not read.
  std::string change;  ///< Describes data that differed when read again; empty if none did.
};

/// Records hashes of the data that is read of a sequence, and detects changes when data is read
/// again. Thread-safe.
class LoadRecord {
 public:
  explicit LoadRecord(std::size_t scans);

  /// @throws DataError if this scan, or its labels, were read before and have changed
  void add(const Scan& scan);
  void add(const Scan& scan, const std::vector<std::uint32_t>& labels);
  [[nodiscard]] LoadedData data() const;

 private:
  void add(std::vector<std::string>& known, const Scan& scan, const std::string& hash,
           const char* what);

  mutable std::mutex mutex_;
  LoadedData data_;
};

/// A sequence whose reading is recorded.
struct WatchedSequence {
  Sequence sequence;  ///< As given; all data that its sources load is added to `record`.
  std::shared_ptr<LoadRecord> record;

  /// Hashes of the data read up to now. @throws DataError if the sensor must be estimated and a
  /// scan cannot be read
  [[nodiscard]] LoadedData loaded() const;
};

WatchedSequence watched(Sequence sequence);

/// Describes the differences between `found` and `expected`; empty if there are none. For
/// `expected`, all data was read; data that was not read for `found` is not compared.
std::string changed_data(const LoadedData& expected, const LoadedData& found);

/// Hash of everything a method or protocol reads: points, reflectance, times, poses and labels of
/// the chosen frames, sensor model, label rule, range limits, and up if it is not the world's z.
/// File and sequence names are left out: a copy of the data elsewhere has the same fingerprint.
/// @param threads used for reading; the result does not depend on it
std::string fingerprint(const Sequence& sequence, int threads);

}  // namespace raymoval
