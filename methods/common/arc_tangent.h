// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// Coefficients, highest power first, of the odd polynomial with the smallest maximum error for the
/// arc tangent from 0 to 45 degrees. The error is below 4e-7.
inline constexpr float kArcTangentTerms[] = {-0.00405456219F, 0.0218629390F, -0.0559123009F,
                                             0.0964219570F,   -0.139086291F, 0.199465662F,
                                             -0.333298594F,   0.999999344F};

}  // namespace raymoval
