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

/// Number of bins of equal width, from 0 to 1. The last bin includes 1.
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
  /// Their mean confidence, and the share that moves; no value without points.
  [[nodiscard]] std::optional<double> mean_confidence() const;
  [[nodiscard]] std::optional<double> moving_share() const;
};

/// Compares confidence with labels: of the points with confidence 0.9, nine of ten should move.
struct Reliability {
  std::array<ReliabilityBin, kConfidenceBins> bins;

  Reliability& operator+=(const Reliability& other);
  /// Mean distance between mean confidence and moving share, over bins weighted by their points
  /// (Naeini et al., Obtaining Well Calibrated Probabilities Using Bayesian Binning, AAAI 2015,
  /// "ECE"); no value without points. Nearly all points are static with a low confidence, see
  /// `mean_gap`.
  [[nodiscard]] std::optional<double> expected_error() const;
  /// The same with equal weight for each bin that has at least `kFewestInBin` points.
  [[nodiscard]] std::optional<double> mean_gap() const;
};

inline constexpr std::int64_t kFewestInBin = 100;

/// Counts the static and moving points (within the sequence's range, not ignored) by confidence, in
/// one pass, for all protocols alike.
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
