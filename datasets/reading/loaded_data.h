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
  std::vector<std::string> names;  ///< Of each scan; empty if it was not read.
  std::string settings;            ///< Sensor, ranges, label rule and all poses.
  std::vector<std::string>
      scans;  ///< Of each scan: time, pose, points, reflectance; empty if not read.
  std::vector<std::string> labels;  ///< Of each scan: its label words; empty if not read.
  std::string change;  ///< Says what differed when it was read again; empty if nothing did.
};

/// Remembers hashes of what is read of a sequence, and notices if data has changed when it is read
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
  Sequence sequence;  ///< As given; all that its sources load is added to `record`.
  std::shared_ptr<LoadRecord> record;

  /// What was read so far. @throws DataError if the sensor has to be estimated and a scan cannot be
  /// read
  [[nodiscard]] LoadedData loaded() const;
};

WatchedSequence watched(Sequence sequence);

/// Says what differs between `found` and `expected`, of which all was read. Empty if all that was
/// read for `found` is the same.
std::string changed_data(const LoadedData& expected, const LoadedData& found);

/// Hash of everything a method or protocol reads: points, reflectance, times, poses and labels of
/// the chosen frames, sensor model, label rule, range limits, and up where it is not the world's z.
/// File and sequence names are left out: a copy of the data elsewhere has the same fingerprint.
/// @param threads used for reading; the answer does not depend on it
std::string fingerprint(const Sequence& sequence, int threads);

}  // namespace raymoval
