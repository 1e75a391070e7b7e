// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// The largest whole number that is not above a value, which must fit an int. `std::floor` is a
/// library call on processors of which no more than SSE2 is asked.
template <class Real>
constexpr int floor_of(Real value) {
  const int whole = static_cast<int>(value);
  return whole - (value < static_cast<Real>(whole) ? 1 : 0);
}

}  // namespace raymoval
