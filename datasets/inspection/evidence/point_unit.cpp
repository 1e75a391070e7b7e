// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/point_unit.h"

#include "datasets/inspection/evidence/pair_fit.h"

namespace raymoval::inspection {
namespace {

/// No sensor on the ground has half of its returns beyond so many metres, ...
constexpr double kFarthestMedian = 400.0;
/// ... and hardly one has them beyond so many, which speaks against centimetres.
constexpr double kFarthestUsual = 100.0;

}  // namespace

double share_in_unit(const Samples& samples, double unit) {
  Samples taken = samples;
  taken.set_point_scale(unit);
  if (taken.pairs().empty()) return 0.0;
  PairFit fit(taken);
  fit.find_best({});
  if (fit.mean_best() < kTooLittle) return 0.0;
  return fit.share([&](std::size_t i) { return taken.poses()[i]; });
}

bool tells_unit(double share, double other) {
  constexpr double kReached = 0.85, kBetter = 0.15;
  return share >= kReached && share > other + kBetter;
}

void settle_point_unit(Samples& samples) {
  if (samples.median_range() < kFarthestMedian) return;
  double unit = kMillimetre;
  if (samples.median_range() * kCentimetre < kFarthestUsual) {
    const double centimetres = share_in_unit(samples, kCentimetre);
    const double millimetres = share_in_unit(samples, kMillimetre);
    if (tells_unit(centimetres, millimetres)) unit = kCentimetre;
    samples.point_unit_is_open = unit == kMillimetre && !tells_unit(millimetres, centimetres);
  }
  samples.set_point_scale(unit);
}

}  // namespace raymoval::inspection
