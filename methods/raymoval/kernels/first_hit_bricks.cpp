// SPDX-License-Identifier: MIT
// The first part of the sweep (see KERNELS.md): the columns and rows of the grid that see a brick.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/simd/compiled_sets.h"
#include "methods/raymoval/kernels/first_hit_sweep.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/first_hit_bricks.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::sweep::bricks {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kGroup>;
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

F number(double value) {
  return hn::Set(Floats(), static_cast<float>(value));
}

F atan2_of(F y, F x) {
  const Floats d;
  const F steep = hn::Abs(y), flat = hn::Abs(x);
  const F small = hn::Min(steep, flat);
  const F large = hn::Max(hn::Max(steep, flat), number(1e-30));
  F angle = hn::Atan(d, hn::Div(small, large));
  angle = hn::IfThenElse(hn::Gt(steep, flat), hn::Sub(number(1.5707963267948966), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(number(3.141592653589793), angle), angle);
  return hn::CopySign(angle, y);
}

/// A brick's tight box as centre and half sides.
struct Solid {
  std::array<F, 3> centre, half;
};

Solid load_solid(const Frame& frame, std::size_t i) {
  const Floats d;
  const F slack = hn::Set(d, frame.slack);
  Solid solid;
  for (std::size_t k = 0; k < 3; ++k) {
    const F low = hn::Load(d, frame.bricks->low[k].data() + i);
    const F high = hn::Load(d, frame.bricks->high[k].data() + i);
    solid.centre[k] = hn::Mul(number(0.5), hn::Add(low, high));
    solid.half[k] = hn::MulAdd(number(0.5), hn::Sub(high, low), slack);
  }
  return solid;
}

F dot(const std::array<double, 3>& axis, const std::array<F, 3>& values) {
  return hn::MulAdd(number(axis[0]), values[0],
                    hn::MulAdd(number(axis[1]), values[1], hn::Mul(number(axis[2]), values[2])));
}

/// A solid in cylindrical coordinates around the sensor's upright axis.
struct Footprint {
  F across_x, across_y;         ///< Centre, along the sensor's x and y.
  F rho_low, rho_high;          ///< Distance from the axis.
  F tangent_low, tangent_high;  ///< Tangents of the angles from the centre's azimuth.
  hn::Mask<Floats> around_axis;
};

Footprint footprint_of(const Frame& frame, const Solid& solid) {
  const Floats d;
  Footprint foot;
  foot.across_x = dot(frame.x_axis, solid.centre);
  foot.across_y = dot(frame.y_axis, solid.centre);
  const F distance =
      hn::Sqrt(hn::MulAdd(foot.across_x, foot.across_x, hn::Mul(foot.across_y, foot.across_y)));
  const F scale = hn::Div(number(1.0), hn::Max(distance, number(1e-6)));
  const F unit_x = hn::Mul(foot.across_x, scale), unit_y = hn::Mul(foot.across_y, scale);
  std::array<F, 3> along, aside;
  F along_reach = hn::Zero(d), aside_reach = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const F x = hn::Mul(number(frame.x_axis[k]), solid.half[k]);
    const F y = hn::Mul(number(frame.y_axis[k]), solid.half[k]);
    along[k] = hn::MulAdd(x, unit_x, hn::Mul(y, unit_y));
    aside[k] = hn::Sub(hn::Mul(y, unit_x), hn::Mul(x, unit_y));
    along_reach = hn::Add(along_reach, hn::Abs(along[k]));
    aside_reach = hn::Add(aside_reach, hn::Abs(aside[k]));
  }
  const F front = hn::Sub(distance, along_reach);
  foot.around_axis = hn::Lt(front, number(1e-3));
  foot.rho_low = hn::Max(front, number(1e-6));
  const F back = hn::Add(distance, along_reach);
  foot.rho_high = hn::Sqrt(hn::MulAdd(back, back, hn::Mul(aside_reach, aside_reach)));
  foot.tangent_low = foot.tangent_high = hn::Zero(d);
  for (int corner = 0; corner < 4; ++corner) {
    const auto signed_sum = [&](const std::array<F, 3>& side) {
      const F y = (corner & 1) != 0 ? hn::Neg(side[1]) : side[1];
      const F z = (corner & 2) != 0 ? hn::Neg(side[2]) : side[2];
      return hn::Add(side[0], hn::Add(y, z));
    };
    const F a = signed_sum(along), c = signed_sum(aside);
    const F one = hn::Div(c, hn::Max(hn::Add(distance, a), number(1e-6)));
    const F other = hn::Div(hn::Neg(c), hn::Max(hn::Sub(distance, a), number(1e-6)));
    foot.tangent_low = hn::Min(foot.tangent_low, hn::Min(one, other));
    foot.tangent_high = hn::Max(foot.tangent_high, hn::Max(one, other));
  }
  return foot;
}

/// Columns whose centres are within the footprint, slightly enlarged.
void find_columns(const Frame& frame, const Footprint& foot, std::size_t i) {
  const Floats d;
  const F azimuth = hn::Add(atan2_of(foot.across_y, foot.across_x), number(3.141592653589793));
  const F per_radian = hn::Set(d, frame.grid->inverse_azimuth_step);
  const F low = hn::Add(azimuth, hn::Atan(d, foot.tangent_low));
  const F high = hn::Add(azimuth, hn::Atan(d, foot.tangent_high));
  const F all = number(frame.grid->columns - 1);
  F first = hn::Add(hn::Floor(hn::MulSub(low, per_radian, number(0.52))), number(1.0));
  F last = hn::Floor(hn::MulSub(high, per_radian, number(0.48)));
  const auto every = hn::Or(foot.around_axis, hn::Ge(hn::Sub(last, first), all));
  first = hn::IfThenElse(every, hn::Zero(d), first);
  last = hn::IfThenElse(every, all, last);
  hn::Store(hn::ConvertTo(Ints(), first), Ints(), frame.bricks->first_column.data() + i);
  hn::Store(hn::ConvertTo(Ints(), last), Ints(), frame.bricks->last_column.data() + i);
}

/// Smallest and largest h / rho for h_low <= h <= h_high and rho_low <= rho <= rho_high.
F lowest_tangent(F height, F rho_low, F rho_high) {
  return hn::Div(height, hn::IfThenElse(hn::Lt(height, hn::Zero(Floats())), rho_low, rho_high));
}
F highest_tangent(F height, F rho_low, F rho_high) {
  return hn::Div(height, hn::IfThenElse(hn::Lt(height, hn::Zero(Floats())), rho_high, rho_low));
}

/// Rows whose centres are within the heights of the solid. @return whether there is one
hn::Mask<Floats> find_rows(const Frame& frame, const Solid& solid, const Footprint& foot,
                           std::size_t i) {
  const Floats d;
  const F height = dot(frame.up, solid.centre);
  F reach = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    reach = hn::MulAdd(number(std::abs(frame.up[k])), solid.half[k], reach);
  }
  const F low = lowest_tangent(hn::Sub(height, reach), foot.rho_low, foot.rho_high);
  const F high = highest_tangent(hn::Add(height, reach), foot.rho_low, foot.rho_high);
  const F origin = hn::Set(d, frame.grid->elevation_min);
  const F per_radian = hn::Set(d, frame.grid->inverse_elevation_step);
  const auto row_at = [&](F tangent, double shift) {
    const F row = hn::MulSub(hn::Sub(hn::Atan(d, tangent), origin), per_radian, number(shift));
    return hn::Floor(hn::Min(hn::Max(row, number(-2.0)), number(frame.grid->rows + 1)));
  };
  const F first = hn::Max(hn::Add(row_at(low, 0.55), number(1.0)), hn::Zero(d));
  const F last = hn::Min(row_at(high, 0.45), number(frame.grid->rows - 1));
  hn::Store(hn::ConvertTo(Ints(), first), Ints(), frame.bricks->first_row.data() + i);
  hn::Store(hn::ConvertTo(Ints(), last), Ints(), frame.bricks->last_row.data() + i);
  return hn::Le(first, last);
}

/// Distance of the solid from the sensor.
F nearest_of(const Solid& solid) {
  const Floats d;
  F sum = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const F gap = hn::Max(hn::Sub(hn::Abs(solid.centre[k]), solid.half[k]), hn::Zero(d));
    sum = hn::MulAdd(gap, gap, sum);
  }
  return hn::Mul(hn::Sqrt(sum), number(1.0 - 1e-6));
}

}  // namespace

void measure(const Frame& frame, std::size_t begin, std::size_t end) {
  const Floats d;
  BrickList& bricks = *frame.bricks;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const Solid solid = load_solid(frame, i);
    const Footprint foot = footprint_of(frame, solid);
    const F nearest = nearest_of(solid);
    hn::Store(nearest, d, bricks.nearest.data() + i);
    find_columns(frame, foot, i);
    const auto seen =
        hn::And(find_rows(frame, solid, foot, i), hn::Le(nearest, hn::Set(d, frame.maximum_range)));
    const auto first = hn::Load(Ints(), bricks.first_column.data() + i);
    const auto none = hn::Set(Ints(), std::numeric_limits<std::int32_t>::max());
    hn::Store(hn::IfThenElse(hn::RebindMask(Ints(), seen), first, none), Ints(),
              bricks.first_column.data() + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::sweep::bricks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::sweep {
namespace bricks {
HWY_EXPORT(measure);
}  // namespace bricks

void measure_bricks(const Frame& frame, std::size_t begin, std::size_t end) {
  using namespace bricks;
  RAYMOVAL_BEST_KERNEL(measure)(frame, begin, end);
}

}  // namespace raymoval::raymoval_method::sweep
#endif
