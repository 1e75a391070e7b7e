// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/image_kernels.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/raymoval/kernels/image_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::raymoval_method::kernels {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using F = hn::Vec<Floats>;

HWY_INLINE void order(F& a, F& b) {
  const F low = hn::Min(a, b);
  b = hn::Max(a, b);
  a = low;
}

/// Sorts the three rows of each column into `scratch`, with one column more at either end.
void sort_columns(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int stride = job.columns + 2;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    F a = hn::LoadU(d, job.values[0] + i);
    F b = hn::LoadU(d, job.values[1] + i);
    F c = hn::LoadU(d, job.values[2] + i);
    order(a, b);
    order(b, c);
    order(a, b);
    hn::StoreU(a, d, job.scratch + i + 1);
    hn::StoreU(b, d, job.scratch + stride + i + 1);
    hn::StoreU(c, d, job.scratch + 2 * stride + i + 1);
  }
  for (int k = 0; k < 3; ++k) {
    float* line = job.scratch + k * stride;
    line[0] = line[job.columns];
    line[job.columns + 1] = line[1];
  }
}

/// Sorts nine values of which three times three are sorted (the rest of Floyd's network).
HWY_INLINE void sort_nine(std::array<F, 9>& v) {
  for (std::size_t k = 0; k < 3; ++k) {
    order(v[k], v[k + 3]);
    order(v[k + 3], v[k + 6]);
    order(v[k], v[k + 3]);
  }
  constexpr std::array<std::pair<std::size_t, std::size_t>, 7> kRest = {
      {{1, 3}, {5, 7}, {2, 6}, {4, 6}, {2, 4}, {2, 3}, {5, 6}}};
  for (const auto& [a, b] : kRest) order(v[a], v[b]);
}

/// The second smallest of nine values of which three times three are sorted: the second smallest of
/// the three smallest, or a middle one, which is never smaller than its own smallest.
HWY_INLINE F second_smallest(const std::array<F, 9>& v) {
  const F low = hn::Min(v[0], v[3]), high = hn::Max(v[0], v[3]);
  const F middle = hn::Min(v[1], hn::Min(v[4], v[7]));
  return hn::Min(middle, hn::Min(high, hn::Max(low, v[6])));
}

HWY_INLINE F second_largest(const std::array<F, 9>& v) {
  const F low = hn::Min(v[2], v[5]), high = hn::Max(v[2], v[5]);
  const F middle = hn::Max(v[1], hn::Max(v[4], v[7]));
  return hn::Max(middle, hn::Max(low, hn::Min(high, v[8])));
}

/// The value of each window at the rank that its number of finite values has.
HWY_INLINE F value_at_rank(const std::array<F, 9>& sorted, const std::array<int, 10>& ranks) {
  const F infinite = hn::Set(Floats(), std::numeric_limits<float>::infinity());
  const auto value_of = [&](std::size_t count) {
    return sorted[static_cast<std::size_t>(ranks[count])];
  };
  // The infinite ones come last: as many values are finite as the last finite one says.
  F result = value_of(1);
  for (std::size_t count = 2; count <= 9; ++count) {
    result = hn::IfThenElse(hn::Lt(sorted[count - 1], infinite), value_of(count), result);
  }
  return result;
}

/// The percentiles of the windows around columns i .. i + Lanes - 1.
HWY_INLINE void find_percentiles(const WindowRow& job, int i, hn::Mask<Floats> wanted) {
  const Floats d;
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  std::array<F, 9> v;
  for (int k = 0; k < 9; ++k) {
    v[static_cast<std::size_t>(k)] =
        hn::LoadU(d, job.scratch + k % 3 * (job.columns + 2) + i + k / 3);
  }
  const F largest = hn::Max(v[2], hn::Max(v[5], v[8]));
  const bool is_full = hn::AllFalse(d, hn::AndNot(hn::Lt(largest, infinite), wanted));
  std::array<F, 9> sorted = v;
  bool is_sorted = false;
  for (std::size_t q = 0; q < 2; ++q) {
    if (job.results[q] == nullptr) continue;
    F result;
    if (is_full && job.ranks[q][9] == 1) {
      result = second_smallest(v);
    } else if (is_full && job.ranks[q][9] == 7) {
      result = second_largest(v);
    } else {
      if (!is_sorted) sort_nine(sorted);
      is_sorted = true;
      result = value_at_rank(sorted, job.ranks[q]);
    }
    hn::StoreU(result, d, job.results[q] + i);
  }
}

void percentiles(const WindowRow& job) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  bool sorted = false;
  for (int next = 0; next < job.columns; next += lanes) {
    const int i = std::min(next, job.columns - lanes);
    const auto wanted = hn::Lt(hn::LoadU(d, job.wanted + i), infinite);
    if (hn::AllFalse(d, wanted)) continue;
    if (!sorted) sort_columns(job);
    sorted = true;
    find_percentiles(job, i, wanted);
  }
}

/// Smallest of the values at columns i - radius .. i + radius of a row, lane by lane.
F minimum_along_row(const WindowMinimum& job, const float* row, int i) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  F smallest = hn::LoadU(d, row + i);
  for (int offset = 1; offset <= job.azimuth_radius; ++offset) {
    for (const int at : {i - offset, i + offset}) {
      if (at >= 0 && at + lanes <= job.columns) {
        smallest = hn::Min(smallest, hn::LoadU(d, row + at));
        continue;
      }
      alignas(64) float wrapped[16];  // The circle closes here.
      for (int lane = 0; lane < lanes; ++lane) {
        wrapped[lane] = row[(at + lane + job.columns) % job.columns];
      }
      smallest = hn::Min(smallest, hn::Load(d, wrapped));
    }
  }
  return smallest;
}

void minimum(const WindowMinimum& job, int first, int skip) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto rows = static_cast<std::size_t>(job.rows);
  const auto reach = static_cast<std::size_t>(job.elevation_radius);
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  for (std::size_t j = 0; j < rows + 2 * reach; ++j) {
    const bool is_row = j >= reach && j < reach + rows;
    const float* row =
        job.values + (is_row ? j - reach : 0) * static_cast<std::size_t>(job.columns);
    hn::Store(is_row ? minimum_along_row(job, row, first) : infinite, d, job.scratch + j * lanes);
  }
  // Minima over 2, 4, 8 ... rows, in place, as long as the window holds them.
  const std::size_t window = 2 * reach + 1;
  std::size_t span = 1;
  for (; 2 * span <= window; span *= 2) {
    for (std::size_t j = 0; j + 2 * span <= rows + 2 * reach; ++j) {
      float* here = job.scratch + j * lanes;
      hn::Store(hn::Min(hn::Load(d, here), hn::Load(d, here + span * lanes)), d, here);
    }
  }
  for (std::size_t j = 0; j < rows; ++j) {
    const float* here = job.scratch + j * lanes;
    const F smallest = hn::Min(hn::Load(d, here), hn::Load(d, here + (window - span) * lanes));
    float* out = job.result + j * static_cast<std::size_t>(job.columns) + first;
    if (skip == 0) {
      hn::StoreU(smallest, d, out);
    } else {
      alignas(64) float values[16];
      hn::Store(smallest, d, values);
      std::copy(values + skip, values + lanes, out + skip);
    }
  }
}

/// The nearest return around `bin` and the Lanes - 1 bins after it, or kUnknown.
HWY_INLINE F nearest_around(const SuspectSearch& job, int bin) {
  const Floats d;
  const int row = bin / job.columns, column = bin % job.columns;
  const int last = column + static_cast<int>(hn::Lanes(d)) - 1;
  if (column < job.azimuth_radius || last + job.azimuth_radius >= job.columns) {
    return hn::Set(d, kUnknown);
  }
  F nearest = hn::LoadU(d, job.own + bin);
  for (int j = std::max(0, row - job.elevation_radius);
       j <= std::min(job.rows - 1, row + job.elevation_radius); ++j) {
    const float* line = job.own + static_cast<std::ptrdiff_t>(j) * job.columns + column;
    for (int i = -job.azimuth_radius; i <= job.azimuth_radius; ++i) {
      nearest = hn::Min(nearest, hn::LoadU(d, line + i));
    }
  }
  return nearest;
}

std::uint32_t suspects(const SuspectSearch& job, std::size_t bin, float* nearest) {
  const Floats d;
  const F infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const F tau0 = hn::Set(d, job.tau0), tau1 = hn::Set(d, job.tau1);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
    const F own = hn::LoadU(d, job.own + bin + i);
    const F hit = hn::LoadU(d, job.first_hit + bin + i);
    const F reference = hn::LoadU(d, job.reference + bin + i);
    const F margin = hn::Add(tau0, hn::Mul(tau1, reference));
    const auto is_beyond = [&](F seen_to) {
      return hn::And(hn::Gt(hn::Sub(seen_to, hit), tau0),
                     hn::Gt(hn::Sub(seen_to, reference), margin));
    };
    auto seen = hn::And(hn::And(hn::Lt(own, infinite), hn::Lt(hit, infinite)), is_beyond(own));
    if (hn::AllFalse(d, seen)) continue;
    const F around = nearest_around(job, static_cast<int>(bin + i));
    seen = hn::And(seen, hn::Or(hn::Lt(around, hn::Zero(d)), is_beyond(around)));
    hn::StoreU(around, d, nearest + i);
    std::uint64_t bytes = 0;
    hn::StoreMaskBits(d, seen, reinterpret_cast<std::uint8_t*>(&bytes));
    bits |= static_cast<std::uint32_t>(bytes) << i;
  }
  return bits;
}

void finite(const float* values, std::size_t count, std::uint64_t* words) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  std::fill(words, words + (count + 63) / 64, std::uint64_t{0});
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, hn::Lt(hn::LoadU(d, values + i), hn::Set(d, kInfinite)),
                      reinterpret_cast<std::uint8_t*>(&bits));
    words[i / 64] |= bits << i % 64;
  }
  for (; i < count; ++i) words[i / 64] |= std::uint64_t{values[i] < kInfinite} << i % 64;
}

}  // namespace

ImageKernels image_kernels() {
  return {static_cast<int>(hn::Lanes(Floats())), &percentiles, &minimum, &suspects, &finite};
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::raymoval_method::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::raymoval_method::kernels {

HWY_EXPORT(image_kernels);

ImageKernels best_image_kernels() {
  return RAYMOVAL_BEST_KERNEL(image_kernels)();
}

}  // namespace raymoval::raymoval_method::kernels
#endif
