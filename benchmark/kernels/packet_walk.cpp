// SPDX-License-Identifier: MIT
#include "benchmark/kernels/packet_walk.h"

#include <limits>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmark/kernels/packet_walk.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::kernels_bench {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void walk_lanes(const std::uint32_t* words, float farthest, Packet& packet, std::size_t lane) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::RebindToUnsigned<decltype(d)> du;
  hn::Vec<decltype(d)> next[3], delta[3];
  hn::Vec<decltype(di)> stride[3], left[3];
  for (int k = 0; k < 3; ++k) {
    next[k] = hn::Load(d, packet.next[k] + lane);
    delta[k] = hn::Load(d, packet.delta[k] + lane);
    stride[k] = hn::Load(di, packet.stride[k] + lane);
    left[k] = hn::Load(di, packet.left[k] + lane);
  }
  auto bit = hn::Load(di, packet.bit + lane);
  auto range = hn::Set(d, std::numeric_limits<float>::infinity());
  auto active = hn::Gt(bit, hn::Set(di, -1));
  while (!hn::AllFalse(di, active)) {
    const auto nearest = hn::Min(next[0], hn::Min(next[1], next[2]));
    active = hn::And(active, hn::RebindMask(di, hn::Le(nearest, hn::Set(d, farthest))));
    auto undecided = active;
    for (int k = 0; k < 3; ++k) {
      const auto here = hn::And(undecided, hn::RebindMask(di, hn::Eq(next[k], nearest)));
      undecided = hn::AndNot(here, undecided);
      active = hn::AndNot(hn::And(here, hn::Eq(left[k], hn::Zero(di))), active);
      next[k] = hn::IfThenElse(hn::RebindMask(d, here), hn::Add(next[k], delta[k]), next[k]);
      left[k] = hn::IfThenElse(here, hn::Sub(left[k], hn::Set(di, 1)), left[k]);
      bit = hn::IfThenElse(here, hn::Add(bit, stride[k]), bit);
    }
    const auto safe = hn::IfThenElseZero(active, bit);
    const auto word =
        hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(words), hn::ShiftRight<5>(safe));
    const auto one = hn::ShiftLeft<31>(
        hn::Shr(hn::BitCast(du, word), hn::BitCast(du, hn::And(safe, hn::Set(di, 31)))));
    const auto hit = hn::And(active, hn::Lt(hn::BitCast(di, one), hn::Zero(di)));
    range = hn::IfThenElse(hn::RebindMask(d, hit), nearest, range);
    active = hn::AndNot(hit, active);
  }
  hn::Store(range, d, packet.range + lane);
}

void walk(const std::uint32_t* words, float farthest, Packet& packet) {
  for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(hn::CappedTag<float, 16>())) {
    walk_lanes(words, farthest, packet, lane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::kernels_bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymoval::kernels_bench {

HWY_EXPORT(walk);

void walk_packet(const std::uint32_t* words, float farthest, Packet& packet) {
  HWY_DYNAMIC_DISPATCH(walk)(words, farthest, packet);
}

}  // namespace raymoval::kernels_bench
#endif
