// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// 2 a b / (a + b), and 0 if both are 0. Of PR and RR as fractions it is F1, of SA and DA it is HA.
inline double harmonic_mean(double a, double b) {
  return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
}

/// F1 as a fraction from PR and RR in percent. It is a harmonic mean of two recalls and not the F1
/// of precision and recall.
inline double f1_from_percent(double preservation_rate, double rejection_rate) {
  return harmonic_mean(preservation_rate / 100.0, rejection_rate / 100.0);
}

}  // namespace raymoval
