// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace raymoval {

/// Converts the evidence that a method gives for points (`EvidenceSink`) to a confidence: the share
/// of points with this evidence that move. The curve is fitted to labelled sequences of equal
/// weight by isotonic regression. Its groups are then joined to 14 knots, each time the two whose
/// union lowers the likelihood least. Using the curve needs no labels.
struct Calibration {
  struct Knot {
    float evidence = 0.0F;
    float confidence = 0.0F;
  };
  std::string sentence;     ///< What the evidence is made of.
  std::vector<Knot> curve;  ///< Of ascending evidence and confidence. None: there is no confidence.

  [[nodiscard]] bool empty() const { return curve.empty(); }

  /// The confidence that a point of this evidence moves: on straight lines between the knots, and
  /// that of the first or the last one beyond. There has to be a knot.
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
