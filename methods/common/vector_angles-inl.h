// SPDX-License-Identifier: MIT
// Angles of several places at a time, for kernels; included once for each instruction set.
#if defined(RAYMOVAL_VECTOR_ANGLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYMOVAL_VECTOR_ANGLES_INL
#undef RAYMOVAL_VECTOR_ANGLES_INL
#else
#define RAYMOVAL_VECTOR_ANGLES_INL
#endif

#include <cstddef>
#include <iterator>

#include "hwy/highway.h"
#include "methods/common/arc_tangent.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval {
namespace HWY_NAMESPACE {

/// The angle of (x, y) from the x axis, radians in [-pi, pi], with an error below 4e-7; 0 for (0,
/// 0). Beyond 45 degrees the polynomial is rotated and mirrored. Highway's own atan would round
/// differently where multiplication and addition are one instruction.
/// @param d the lanes, of single precision
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V vector_angle(D d, V y, V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr float kStraight = 3.14159265358979F;
  const V across = hn::Abs(x), up = hn::Abs(y);
  const V longer = hn::Max(hn::Max(across, up), hn::Set(d, 1e-30F));  // Not 0: it divides.
  const V ratio = hn::Div(hn::Min(across, up), longer);
  const V square = hn::Mul(ratio, ratio);
  V sum = hn::Set(d, kArcTangentTerms[0]);
  for (std::size_t k = 1; k < std::size(kArcTangentTerms); ++k) {
    sum = hn::Add(hn::Mul(sum, square), hn::Set(d, kArcTangentTerms[k]));
  }
  V angle = hn::Mul(sum, ratio);
  angle = hn::IfThenElse(hn::Gt(up, across), hn::Sub(hn::Set(d, 0.5F * kStraight), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, kStraight), angle), angle);
  return hn::CopySign(angle, y);
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval
HWY_AFTER_NAMESPACE();

#endif
