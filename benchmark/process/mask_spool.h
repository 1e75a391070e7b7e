// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/scan_spool.h"
#include "benchmark/process/timed_source.h"
#include "methods/remover.h"

namespace raymoval {

/// Keeps a method's masks in a file without a name, one bit per point, and checks them as
/// `CheckedSink` does. In memory it keeps a few numbers per scan.
class MaskSpool : public RemovalSink {
 public:
  /// @param method name for messages
  /// @param beside a path; the file is made in its folder
  /// @throws DataError if it cannot be made
  MaskSpool(std::string method, const TimedSource& scans, const std::filesystem::path& beside);

  /// @throws MethodError as `CheckedSink::accept`; DataError if the disk is full
  void accept(std::size_t scan, const Mask& mask) override;
  /// @throws MethodError naming the first scan without a mask
  void check_complete() const;
  [[nodiscard]] Mask get(std::size_t scan) const;
  [[nodiscard]] std::uint64_t point_count() const;
  [[nodiscard]] std::uint64_t removed_count() const { return removed_; }

 private:
  struct Entry {
    bool filled = false;
    std::size_t points = 0;
  };

  std::string method_;
  const TimedSource& scans_;
  ScanSpool file_;
  std::mutex mutex_;
  std::vector<Entry> entries_;
  std::uint64_t removed_ = 0;
};

/// Keeps a method's confidence in a file without a name, a byte for each point.
class ConfidenceSpool : public CheckedConfidence {
 public:
  /// @param calibration must outlive this object. The others are as those of `MaskSpool`.
  /// @throws DataError if the file cannot be made
  ConfidenceSpool(std::string method, const Calibration& calibration, const TimedSource& scans,
                  const std::filesystem::path& beside)
      : CheckedConfidence(std::move(method), calibration, scans),
        file_("confidence", beside, scans.size()) {}

  /// The steps of a scan's points, see `kConfidenceSteps`.
  [[nodiscard]] std::string get(std::size_t scan) const { return file_.get(scan); }

 private:
  void keep(std::size_t scan, std::string steps) override { file_.put(scan, steps); }
  ScanSpool file_;
};

}  // namespace raymoval
