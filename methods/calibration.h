// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace raymoval {

/// Converts the evidence that a method gives for points (`EvidenceSink`) to a confidence: the share
/// of points with this evidence that move. The curve is fitted to labelled sequences of equal
/// weight by isotonic regression. Its groups are then joined to 14 knots: each step joins the two
/// groups whose union lowers the likelihood least. Using the curve needs no labels.
struct Calibration {
  struct Knot {
    float evidence = 0.0F;
    float confidence = 0.0F;
  };
  std::string sentence;     ///< Description of the evidence.
  std::vector<Knot> curve;  ///< Ascending in evidence and confidence. Empty: no confidence.

  [[nodiscard]] bool empty() const { return curve.empty(); }

  /// The confidence that a point with this evidence moves: linear between the knots, constant
  /// beyond the first and the last one. There must be a knot.
  [[nodiscard]] float confidence(float evidence) const {
    const auto above =
        std::upper_bound(curve.begin(), curve.end(), evidence,
                         [](float value, const Knot& knot) { return value < knot.evidence; });
    if (above == curve.begin()) return curve.front().confidence;
    if (above == curve.end()) return curve.back().confidence;
    const Knot& low = *(above - 1);
    const float along = (evidence - low.evidence) / (above->evidence - low.evidence);
    return low.confidence + along * (above->confidence - low.confidence);
  }
};

}  // namespace raymoval
