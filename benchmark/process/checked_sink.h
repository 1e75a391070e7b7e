// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/process/timed_source.h"
#include "benchmark/result/removals/reasons.h"
#include "core/scan/confidence_store.h"
#include "core/scan/mask_store.h"
#include "methods/calibration.h"
#include "methods/remover.h"

namespace raymoval {

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
