// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "core/angle.h"

namespace raymoval::inspection {
namespace {

constexpr int kArcs = 72;

struct Ray {
  double azimuth, elevation;
};

std::vector<Ray> sorted_rays(const Scan& scan) {
  std::vector<Ray> rays;
  rays.reserve(scan.size());
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d p = point.cast<double>();
    if (p.norm() < 1e-3) continue;
    rays.push_back({std::atan2(p.y(), p.x()), std::atan2(p.z(), p.head<2>().norm())});
  }
  std::sort(rays.begin(), rays.end(),
            [](const Ray& a, const Ray& b) { return a.azimuth < b.azimuth; });
  return rays;
}

/// Points of an arc, and how many of them have a partner.
struct Arc {
  std::size_t points = 0, paired = 0;

  [[nodiscard]] double share() const {
    constexpr std::size_t kFewest = 20;
    return points < kFewest ? 0.0 : static_cast<double>(paired) / static_cast<double>(points);
  }
};

/// By arcs of azimuth from -pi on. A partner lies nearer than the next column and the next beam.
std::array<Arc, kArcs> count_partners(const std::vector<Ray>& rays, const SensorModel& seen) {
  constexpr double kPartOfColumn = 0.6, kPartOfBeam = 0.2;
  const double wide = kPartOfColumn * seen.azimuth_step;
  const double high = kPartOfBeam * seen.elevation_step;
  std::vector<bool> paired(rays.size(), false);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size() && rays[j].azimuth - rays[i].azimuth <= wide; ++j) {
      if (std::abs(rays[j].elevation - rays[i].elevation) > high) continue;
      paired[i] = paired[j] = true;
    }
  }
  std::array<Arc, kArcs> arcs;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const int at = static_cast<int>((rays[i].azimuth + std::numbers::pi) / kTurn * kArcs);
    Arc& arc = arcs[static_cast<std::size_t>(std::clamp(at, 0, kArcs - 1))];
    ++arc.points;
    arc.paired += paired[i] ? 1 : 0;
  }
  return arcs;
}

}  // namespace

std::optional<Overlap> find_overlap(const Scan& scan, const SensorModel& seen) {
  constexpr double kMost = 0.5, kFew = 0.3;
  constexpr int kFewestArcs = 3, kMostArcs = kArcs - 6;
  if (!(seen.azimuth_step > 0.0) || !(seen.elevation_step > 0.0) || !seen.has_beams()) return {};
  const std::array<Arc, kArcs> arcs = count_partners(sorted_rays(scan), seen);
  int longest = 0, end = 0, run = 0;
  for (int at = 0; at < 2 * kArcs; ++at) {
    run = arcs[static_cast<std::size_t>(at % kArcs)].share() >= kMost ? run + 1 : 0;
    if (run > longest) {
      longest = run;
      end = at + 1;
    }
  }
  if (longest < kFewestArcs || longest > kMostArcs) return {};
  Arc outside;
  for (int at = end + 1; at < end - longest + kArcs - 1; ++at) {
    outside.points += arcs[static_cast<std::size_t>(at % kArcs)].points;
    outside.paired += arcs[static_cast<std::size_t>(at % kArcs)].paired;
  }
  if (outside.share() > kFew) return {};
  Overlap overlap;
  overlap.width = longest * kTurn / kArcs;
  overlap.from = (end - longest) * kTurn / kArcs - std::numbers::pi;
  return overlap;
}

}  // namespace raymoval::inspection
