// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval::toy {

/// What a change of the input may do to the verdicts on the points that are still there.
enum class Claim : char {
  kSame = '=',      ///< Nothing.
  kRounding = '~',  ///< Nothing but for rounding, which may decide for single points.
  kMore = '+',      ///< What was removed stays removed; more may go.
  kFewer = '-',     ///< What was kept stays kept; more may stay.
  kOpen = '?',      ///< Anything.
};

struct Claims {
  std::string variant;       ///< Such as "raymoval:online".
  std::vector<Claim> about;  ///< In the order of `changes`.
};

/// What each variant of each method promises; those of a variant are a line of claims.cpp, or
/// those that every method must hold.
const std::vector<Claims>& claims();

}  // namespace raymoval::toy
