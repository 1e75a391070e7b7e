// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace raymoval {

/// Positions of at most `most` of `count` items, evenly spread. If there are two or more positions,
/// the first and the last item are among them.
inline std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(count, most));
  for (std::size_t k = 1; k < chosen.size(); ++k) chosen[k] = k * (count - 1) / (chosen.size() - 1);
  return chosen;
}

/// The median; of an even count the upper of the two middle values. It reorders the values.
/// @param values at least one
template <class Value>
Value median_in_place(std::vector<Value>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The same, without reordering the caller's values.
template <class Value>
Value median(std::vector<Value> values) {
  return median_in_place(values);
}

/// The middle value, or the mean of both middle ones. It reorders the values.
/// @param values at least one
inline double middle_value(std::vector<double>& values) {
  const double upper = median_in_place(values);
  if (values.size() % 2 == 1) return upper;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return 0.5 * (*std::max_element(values.begin(), half) + upper);
}

}  // namespace raymoval
