// SPDX-License-Identifier: MIT
#pragma once

#include "core/sampling.h"

namespace raymoval {

/// The middle value, or the mean of both middle ones. It reorders the values.
/// @param values at least one
inline double middle_value(std::vector<double>& values) {
  const double upper = median_in_place(values);
  if (values.size() % 2 == 1) return upper;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return 0.5 * (*std::max_element(values.begin(), half) + upper);
}

}  // namespace raymoval
