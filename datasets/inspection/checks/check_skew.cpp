// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/angle.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kFarPairs = 8, kFewestFarPairs = 3;
constexpr double kDistance = 6.0;      // metres of path between the scans of a pair
constexpr double kMostStep = 4.5;      // metres to the next scan, else scans are left out between
constexpr double kReach = 0.1;         // metres; skew moves surfaces by decimetres
constexpr double kLeastAcross = 0.05;  // share of surfels
constexpr double kClear = 1.03;        // on good data undoing a skew makes the agreement worse

/// One revolution of a sensor.
struct Sweep {
  double cut = 0.0;   ///< Azimuth of its beginning, radians.
  int direction = 1;  ///< +1 counter-clockwise, -1 clockwise.
  const char* text = "";
};

constexpr double kQuarter = std::numbers::pi / 2.0;
constexpr std::array kSweeps = {Sweep{0.0, 1, "counter-clockwise from ahead"},
                                Sweep{kQuarter, 1, "counter-clockwise from the left"},
                                Sweep{2.0 * kQuarter, 1, "counter-clockwise from behind"},
                                Sweep{3.0 * kQuarter, 1, "counter-clockwise from the right"},
                                Sweep{0.0, -1, "clockwise from ahead"},
                                Sweep{kQuarter, -1, "clockwise from the left"},
                                Sweep{2.0 * kQuarter, -1, "clockwise from behind"},
                                Sweep{3.0 * kQuarter, -1, "clockwise from the right"}};

/// The time of a direction in the sweep, -0.5 to 0.5.
double phase(const Eigen::Vector3d& point, const Sweep& sweep) {
  const double turns = sweep.direction * (std::atan2(point.y(), point.x()) - sweep.cut) / kTurn;
  return turns - std::floor(turns) - 0.5;
}

/// Surfels of a scan, corrected for motion during the sweep.
std::vector<Surfel> unskewed(std::vector<Surfel> surfels, const Pose& motion, const Sweep& sweep) {
  for (Surfel& surfel : surfels) {
    const Pose moved = part_of(motion, phase(surfel.mean, sweep));
    surfel.mean = moved * surfel.mean;
    surfel.axis = moved.linear() * surfel.axis;
  }
  return surfels;
}

/// Motion of the sensor during the sweep of `scan`, from the poses before and after.
Pose motion_during(const Samples& samples, std::size_t scan) {
  const auto& poses = samples.poses();
  return part_of(poses[scan - 1].inverse() * poses[scan + 1], 0.5);
}

/// Pairs that are far apart, so that the same surface is in other directions.
std::vector<ScanPair> far_pairs(const Samples& samples) {
  const auto& poses = samples.poses();
  std::vector<double> way(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    way[i] = way[i - 1] + (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  std::vector<ScanPair> all;
  for (std::size_t i = 1, j = 1; i + 1 < poses.size(); ++i) {
    while (j + 1 < poses.size() && way[j] - way[i] < kDistance) ++j;
    if (j + 1 >= poses.size()) break;
    all.push_back({i, j});
  }
  std::vector<ScanPair> chosen;
  for (const std::size_t k : evenly_spread(all.size(), kFarPairs)) chosen.push_back(all[k]);
  return chosen;
}

/// Share of surfels that constrain the motion along the path: planes that face it, and poles across
/// it. Along a tunnel, skew changes nothing.
double share_across(const std::vector<Surfel>& surfels, const Pose& motion) {
  const Eigen::Vector3d way = motion.translation().normalized();
  const auto across = std::count_if(surfels.begin(), surfels.end(), [&](const Surfel& surfel) {
    const double along = std::abs(surfel.axis.dot(way));
    return surfel.is_line() ? along < 0.9 : along > 0.3;
  });
  return surfels.empty() ? 0.0 : static_cast<double>(across) / static_cast<double>(surfels.size());
}

double registered(const std::vector<Surfel>& from, const std::vector<Surfel>& to,
                  const Pose& motion) {
  const SurfaceMap map(from);
  return map.agreement(to, map.refine(to, motion), kReach);
}

/// Agreements of all pairs, as stored and with each sweep corrected.
struct SkewFit {
  std::vector<double> given;                                 ///< By pair.
  std::array<std::vector<double>, kSweeps.size()> undone{};  ///< By sweep and pair.

  [[nodiscard]] static double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  }
  /// Number of pairs that agree better with the correction.
  [[nodiscard]] std::size_t better(std::size_t sweep) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < given.size(); ++k) count += undone[sweep][k] > given[k] ? 1 : 0;
    return count;
  }
};

SkewFit fit_sweeps(const Samples& samples, const std::vector<ScanPair>& pairs) {
  SkewFit fit;
  for (const ScanPair& pair : pairs) {
    const std::vector<Surfel>&from = samples.surfels(pair.from), &to = samples.surfels(pair.to);
    const Pose motion = samples.poses()[pair.from].inverse() * samples.poses()[pair.to];
    const Pose from_motion = motion_during(samples, pair.from);
    const Pose to_motion = motion_during(samples, pair.to);
    fit.given.push_back(registered(from, to, motion));
    for (std::size_t k = 0; k < kSweeps.size(); ++k) {
      fit.undone[k].push_back(registered(unskewed(from, from_motion, kSweeps[k]),
                                         unskewed(to, to_motion, kSweeps[k]), motion));
    }
  }
  return fit;
}

/// Finds skewed scans, in which each point is in the sensor frame at its own time. In skewed scans,
/// correcting the motion makes far scans agree better, and correcting the opposite motion makes
/// them agree worse; in other scans, both make them agree worse.
std::vector<Finding> look_for_skew(Samples& samples) {
  if (!pose_verdict(samples).check.empty()) return {};
  if (samples.median_step() > kMostStep) return {};
  const std::vector<ScanPair> pairs = far_pairs(samples);
  if (pairs.size() < kFewestFarPairs) return {};
  double across = 0.0;
  for (const ScanPair& pair : pairs) {
    across += share_across(samples.surfels(pair.from),
                           samples.poses()[pair.from].inverse() * samples.poses()[pair.to]) /
              static_cast<double>(pairs.size());
  }
  samples.measures.emplace_back("share_of_surfels_across_way", across);
  if (across < kLeastAcross) return {};
  const SkewFit fit = fit_sweeps(samples, pairs);
  std::size_t best = 0;
  for (std::size_t k = 1; k < kSweeps.size(); ++k) {
    if (SkewFit::sum(fit.undone[k]) > SkewFit::sum(fit.undone[best])) best = k;
  }
  const std::size_t opposite = (best + kSweeps.size() / 2) % kSweeps.size();
  const double given = SkewFit::sum(fit.given);
  if (given <= 0.0) return {};
  const double gain = SkewFit::sum(fit.undone[best]) / given;
  const double loss = SkewFit::sum(fit.undone[opposite]) / given;
  samples.measures.emplace_back("agreement_unskewed_by_given", gain);
  samples.measures.emplace_back("agreement_skewed_twice_by_given", loss);
  samples.measures.emplace_back(
      "share_of_pairs_better_unskewed",
      static_cast<double>(fit.better(best)) / static_cast<double>(pairs.size()));
  if (gain < kClear || loss > 1.0 || 4 * fit.better(best) < 3 * pairs.size()) return {};
  return {{.where = "points of all scans",
           .what = fmt::format("scans {} m apart fit {} % better if the sensor's motion is undone "
                               "within each (sweep {})",
                               fixed_text(kDistance, 0), fixed_text(100.0 * (gain - 1.0), 0),
                               kSweeps[best].text)}};
}

}  // namespace

std::vector<Check> skew_checks() {
  return {{"skewed-scans", "points are not corrected for the motion of the sensor during a scan",
           "all points of a scan in the sensor's frame at one time",
           "If points have times, use --deskew. Else correct each point with the motion between "
           "its time and that of the scan (deskewing, as LiDAR odometry programs do).",
           look_for_skew}};
}

}  // namespace raymoval::inspection
