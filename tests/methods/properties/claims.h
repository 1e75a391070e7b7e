// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval::toy {

/// What a change of the input may do to the verdicts on the points that are still there.
enum class Claim : char {
  kSame = '=',      ///< Nothing.
  kRounding = '~',  ///< No change except by rounding, which may decide single points.
  kMore = '+',      ///< What was removed stays removed; more may go.
  kFewer = '-',     ///< What was kept stays kept; more may stay.
  kOpen = '?',      ///< Anything.
};

struct Claims {
  std::string variant;       ///< Such as "raymoval:online".
  std::vector<Claim> about;  ///< In the order of `changes`.
};

/// The claims of each variant of each method: its line in claims.cpp, or the claims of all methods.
const std::vector<Claims>& claims();

}  // namespace raymoval::toy
