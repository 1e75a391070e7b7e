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

/// @throws MethodError for an unknown scan, a wrong size, or a value that is neither 0 nor 1
void check_answer(const std::string& method, const TimedSource& scans, std::size_t scan,
                  const Mask& mask);
[[noreturn]] void throw_second_answer(const std::string& method, std::size_t scan);
[[noreturn]] void throw_missing_answer(const std::string& method, std::size_t scan,
                                       std::size_t scans);

/// Keeps a method's masks and checks that the method keeps to its contract.
class CheckedSink : public RemovalSink {
 public:
  /// @param method name for messages
  CheckedSink(std::string method, const TimedSource& scans)
      : method_(std::move(method)), scans_(scans), masks_(scans.size()) {}

  /// @throws MethodError for an unknown scan, a second mask, a wrong size, or a value that is
  /// neither 0 nor 1.
  void accept(std::size_t scan, const Mask& mask) override;

  /// The masks. @throws MethodError that names the first scan without a mask
  [[nodiscard]] const MaskStore& finish() const;

 private:
  std::string method_;
  const TimedSource& scans_;
  std::mutex mutex_;
  MaskStore masks_;
};

/// Keeps a method's reasons and holds it to the contract of `ReasonSink`.
class ReasonStore : public ReasonSink {
 public:
  /// @param method name for messages
  ReasonStore(std::string method, const TimedSource& scans)
      : method_(std::move(method)), scans_(scans) {}

  /// @throws MethodError for no or more than 127 sentences, or a second call
  void explain(const std::vector<std::string>& sentences) override;
  /// @throws MethodError before `explain`, and for an unknown scan, a wrong size or an unknown code
  void accept(std::size_t scan, const std::vector<std::uint8_t>& codes) override;
  /// What was given; scans without reasons have none.
  [[nodiscard]] Reasons finish();

 private:
  std::string method_;
  const TimedSource& scans_;
  std::mutex mutex_;
  Reasons reasons_;
};

/// Makes a confidence of a method's evidence, and holds the method to the contract of
/// `EvidenceSink`. Where it is kept is left to others.
class CheckedConfidence : public EvidenceSink {
 public:
  /// @param method name for messages
  /// @param calibration not empty; must outlive this object
  CheckedConfidence(std::string method, const Calibration& calibration, const TimedSource& scans)
      : method_(std::move(method)),
        calibration_(calibration),
        scans_(scans),
        is_filled_(scans.size(), 0) {}

  /// @throws MethodError for an unknown scan, a second answer, a wrong size, or a value that is not
  /// from 0 to 1
  void accept(std::size_t scan, std::span<const float> evidence) override;
  /// @throws MethodError that names the first scan without values
  void check_complete() const;

 protected:
  /// Takes the steps of a scan's points, by one thread at a time.
  virtual void keep(std::size_t scan, std::string steps) = 0;

 private:
  std::string method_;
  const Calibration& calibration_;
  const TimedSource& scans_;
  std::mutex mutex_;
  std::vector<std::uint8_t> is_filled_;  ///< By scan.
};

/// Keeps a method's confidence in memory, a byte for each point.
class KeptConfidence : public CheckedConfidence {
 public:
  KeptConfidence(std::string method, const Calibration& calibration, const TimedSource& scans)
      : CheckedConfidence(std::move(method), calibration, scans),
        kept_{std::vector<std::string>(scans.size())} {}

  /// What was given. @throws MethodError as `check_complete`
  [[nodiscard]] ConfidenceStore finish();

 private:
  void keep(std::size_t scan, std::string steps) override { kept_.steps[scan] = std::move(steps); }
  ConfidenceStore kept_;
};

/// Hash of all masks. Two methods gave the same answer exactly if their hashes are equal.
std::string mask_digest(const MaskStore& masks);

}  // namespace raymoval
