// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scan/confidence_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// So many bins of equal width, from 0 to 1. The last one has 1, too.
inline constexpr std::size_t kConfidenceBins = 10;

/// The bin of a confidence in steps, see `kConfidenceSteps`.
inline std::size_t confidence_bin(std::uint8_t steps) {
  return std::min(kConfidenceBins - 1, steps * kConfidenceBins / kConfidenceSteps);
}

/// Points with a confidence in one bin.
struct ReliabilityBin {
  std::int64_t points = 0;
  std::int64_t moving = 0;  ///< By their labels.
  std::int64_t steps = 0;   ///< Sum of their confidence in steps, see `kConfidenceSteps`.

  ReliabilityBin& operator+=(const ReliabilityBin& other);
  /// What was said of them, and what came true; no value without points.
  [[nodiscard]] std::optional<double> mean_confidence() const;
  [[nodiscard]] std::optional<double> moving_share() const;
};

/// Whether what a method says of points comes true: of those said 0.9, nine of ten should move.
struct Reliability {
  std::array<ReliabilityBin, kConfidenceBins> bins;

  Reliability& operator+=(const Reliability& other);
  /// Mean distance between what was said and what came true, over bins weighted by their points
  /// (Naeini et al., Obtaining Well Calibrated Probabilities Using Bayesian Binning, AAAI 2015,
  /// "ECE"); no value without points. Nearly all points stay, and are said to: see `mean_gap`.
  [[nodiscard]] std::optional<double> expected_error() const;
  /// The same over bins that count alike, of those with `kFewestInBin` points or more.
  [[nodiscard]] std::optional<double> mean_gap() const;
};

inline constexpr std::int64_t kFewestInBin = 100;

/// Counts the points whose labels say whether they move (within the sequence's range, not ignored)
/// by confidence, in one pass. No protocol has a say.
class ReliabilityCount : public ScanVisitor {
 public:
  /// @param input,confidence must outlive this object. @throws DataError if there are no labels
  /// @throws MethodError if there are not as many scans as in the input
  ReliabilityCount(const EvaluationInput& input, const ConfidenceStore& confidence);

  bool begin_pass(std::size_t slots) override;
  void read(const CheckedScan& scan, std::size_t slot) override;
  void take(std::size_t slot) override;
  [[nodiscard]] const Reliability& reliability() const { return all_; }

 private:
  const EvaluationInput& input_;
  const ConfidenceStore& confidence_;
  std::vector<Reliability> slots_;
  Reliability all_;
};

}  // namespace raymoval
