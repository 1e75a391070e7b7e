// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "benchmark/result/removals/reasons.h"
#include "core/scan/confidence_store.h"
#include "core/scan/mask_store.h"
#include "core/scan/scan_source.h"
#include "methods/calibration.h"
#include "methods/remover.h"

namespace raymoval {

/// The contract of an online method: it loads each scan once, and gives the mask of scan t before
/// it loads a scan that is more than `delay_s` later. The check is exact with one thread. With N
/// threads a method may hold two batches of N scans (see methods/common/prepared_scans.h).
struct OnlineRule {
  std::string method;  ///< For messages.
  double delay_s = 0.0;
  int threads = 1;
};

/// Passes on the scans of a source. It measures the reading time, so that it can be subtracted from
/// a method's time, and stores the number of points of each scan.
class TimedSource : public ScanSource {
 public:
  /// The calling thread becomes the owner: the time that it waits is not counted as the method's.
  /// @param rule of the method that reads; no value if it is offline
  explicit TimedSource(const ScanSource& source, std::optional<OnlineRule> rule = std::nullopt)
      : source_(source),
        owner_(std::this_thread::get_id()),
        rule_(std::move(rule)),
        counts_(source.size()),
        times_(source.size()) {}
  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  /// @throws MethodError if an online method loads a scan twice
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return source_.pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return source_.sensor(); }

  /// The seconds that the owning thread has spent in `load`.
  [[nodiscard]] double waited_seconds() const;
  /// The number of points of scan `index`. Reads the scan only if it was not read yet.
  [[nodiscard]] std::size_t point_count(std::size_t index) const;
  /// @throws MethodError if an online method gives the mask of scan `index` too late
  void check_in_time(std::size_t index) const;

 private:
  const ScanSource& source_;
  std::thread::id owner_;
  std::optional<OnlineRule> rule_;
  mutable std::mutex mutex_;
  mutable double waited_ = 0.0;
  mutable std::vector<std::optional<std::size_t>> counts_;
  mutable std::vector<std::optional<double>> times_;  ///< Of the loaded scans.
  mutable std::size_t end_ = 0;                       ///< One after the last of these.
};

/// Keeps a method's masks and checks that the method keeps to the contract of `RemovalSink`.
class CheckedSink : public RemovalSink {
 public:
  /// @param method name for messages
  /// @param masks where they are kept: empty, for as many scans
  CheckedSink(std::string method, const TimedSource& scans, MaskStore masks)
      : method_(std::move(method)), scans_(scans), masks_(std::move(masks)) {}

  /// @throws MethodError for an unknown scan, a second mask, a wrong size, or a value that is
  /// neither 0 nor 1; DataError as `ScanSpool::put`
  void accept(std::size_t scan, const Mask& mask) override;

  /// The masks. @throws MethodError that names the first scan without a mask
  [[nodiscard]] MaskStore finish();

 private:
  std::string method_;
  const TimedSource& scans_;
  std::mutex mutex_;
  MaskStore masks_;
};

/// Keeps a method's reasons and checks that the method keeps to the contract of `ReasonSink`.
class CheckedReasons : public ReasonSink {
 public:
  /// @param method name for messages
  CheckedReasons(std::string method, const TimedSource& scans)
      : method_(std::move(method)), scans_(scans) {}

  /// @throws MethodError for no or more than 127 sentences, or a second call
  void explain(const std::vector<std::string>& sentences) override;
  /// @throws MethodError before `explain`, and for an unknown scan, a wrong size or an unknown code
  void accept(std::size_t scan, const std::vector<std::uint8_t>& codes) override;
  /// The reasons; scans without reasons have none.
  [[nodiscard]] Reasons finish() { return std::move(reasons_); }

 private:
  std::string method_;
  const TimedSource& scans_;
  std::mutex mutex_;
  Reasons reasons_;
};

/// Keeps the confidences that follow from a method's evidence, and checks that the method keeps to
/// the contract of `EvidenceSink`.
class CheckedConfidence : public EvidenceSink {
 public:
  /// @param method name for messages
  /// @param calibration not empty; must outlive this object
  /// @param steps where the confidences are kept: empty, for as many scans
  CheckedConfidence(std::string method, const Calibration& calibration, const TimedSource& scans,
                    ScanSpool steps)
      : method_(std::move(method)),
        calibration_(calibration),
        scans_(scans),
        kept_{std::move(steps)} {}

  /// @throws MethodError for an unknown scan, a second answer, a wrong size, or a value that is not
  /// from 0 to 1; DataError as `ScanSpool::put`
  void accept(std::size_t scan, std::span<const float> evidence) override;

  /// The confidences. @throws MethodError that names the first scan without values
  [[nodiscard]] ConfidenceStore finish();

 private:
  std::string method_;
  const Calibration& calibration_;
  const TimedSource& scans_;
  std::mutex mutex_;
  ConfidenceStore kept_;
};

/// Hash of all masks. Two methods gave the same answer exactly if their hashes are equal.
std::string mask_digest(const MaskStore& masks);

}  // namespace raymoval
