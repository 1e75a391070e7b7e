// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/sampling.h"
#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval::inspection {
namespace {

/// The azimuths that a scan of more than one revolution passes twice, counter-clockwise.
struct Overlap {
  double from = 0.0;   ///< Radians, -pi to pi.
  double width = 0.0;  ///< Radians.

  [[nodiscard]] double to() const { return from + width; }
};

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

/// Where most points of `scan` have another one in about the same direction, and few have
/// elsewhere; to 5 degrees. None below 15 degrees, and none for a sensor without beams. Both
/// returns of a pulse give no overlap, for they lie all around.
/// @param seen the sensor as its scans show it
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

constexpr std::size_t kFarPairs = 8, kFewestFarPairs = 3;
constexpr double kDistance = 6.0;  // metres of way between the scans of a pair
constexpr double kReach = 0.1;     // metres; skew moves surfaces by decimetres
constexpr double kClear = 1.03;    // on good data undoing a skew makes the agreement worse

/// How a sensor may sweep: from the azimuth of its cut, once around or somewhat more.
struct Sweep {
  double cut = 0.0;   ///< Azimuth in radians.
  int direction = 1;  ///< +1 counter-clockwise, -1 clockwise.
  const char* text = "";
  double twice = 0.0;  ///< Part of a turn from the cut on that is passed again in the end.
};

const std::vector<Sweep>& whole_sweeps() {
  constexpr double kQuarter = std::numbers::pi / 2.0;
  static const std::vector<Sweep> all = {
      {0.0, 1, "counter-clockwise from ahead"},
      {kQuarter, 1, "counter-clockwise from the left"},
      {2.0 * kQuarter, 1, "counter-clockwise from behind"},
      {3.0 * kQuarter, 1, "counter-clockwise from the right"},
      {0.0, -1, "clockwise from ahead"},
      {kQuarter, -1, "clockwise from the left"},
      {2.0 * kQuarter, -1, "clockwise from behind"},
      {3.0 * kQuarter, -1, "clockwise from the right"},
  };
  return all;
}

/// Part of a turn from the start of the sweep to a direction, 0 to 1.
double turns_to(const Eigen::Vector3d& point, const Sweep& sweep) {
  const double turns = sweep.direction * (std::atan2(point.y(), point.x()) - sweep.cut) / kTurn;
  return turns - std::floor(turns);
}

/// When in the sweep a direction is measured, -0.5 to 0.5.
double phase(const Eigen::Vector3d& point, const Sweep& sweep) {
  return turns_to(point, sweep) / (1.0 + sweep.twice) - 0.5;
}

/// Both sweeps of a scan of more than one revolution, which begins where it passes twice.
std::vector<Sweep> sweeps_over(const Overlap& overlap) {
  const double twice = overlap.width / kTurn;
  return {{overlap.from, 1, "counter-clockwise, more than one revolution a scan", twice},
          {overlap.to(), -1, "clockwise, more than one revolution a scan", twice}};
}

/// How the scans may sweep: where each scan has an overlap, from there, else from anywhere.
class Sweeps {
 public:
  Sweeps(const Samples& samples, const std::vector<ScanPair>& pairs) {
    for (const ScanPair& pair : pairs) {
      for (const std::size_t index : {pair.from, pair.to}) {
        const std::optional<Overlap> overlap = overlap_of(samples, index);
        if (!overlap) {
          overlaps_.clear();
          return;
        }
        overlaps_[index] = *overlap;
      }
    }
  }

  [[nodiscard]] std::vector<Sweep> of(std::size_t scan) const {
    const auto found = overlaps_.find(scan);
    return found == overlaps_.end() ? whole_sweeps() : sweeps_over(found->second);
  }

 private:
  static std::optional<Overlap> overlap_of(const Samples& samples, std::size_t index) {
    const auto read = samples.scans().find(index);
    return find_overlap(
        read != samples.scans().end() ? read->second : samples.sequence().scans->load(index),
        samples.seen_sensor());
  }

  std::map<std::size_t, Overlap> overlaps_;  ///< Of all scans, or none.
};

/// Surfels of a scan as they would be without motion during the sweep.
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

/// Without what is passed twice, at two times.
std::vector<Surfel> passed_once(std::vector<Surfel> surfels, const Sweep& sweep) {
  if (sweep.twice <= 0.0) return surfels;
  std::erase_if(surfels,
                [&](const Surfel& surfel) { return turns_to(surfel.mean, sweep) < sweep.twice; });
  return surfels;
}

/// Pairs so far apart that the same surface is seen in other directions.
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

double registered(const std::vector<Surfel>& from, const std::vector<Surfel>& to,
                  const Pose& motion) {
  const SurfaceMap map(from);
  return map.agreement(to, map.refine(to, motion), kReach);
}

/// Agreements of all pairs, as they stand and with each sweep undone.
struct SkewFit {
  std::vector<double> given;                ///< By pair.
  std::vector<std::vector<double>> undone;  ///< By sweep and pair.

  [[nodiscard]] static double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  }
  /// Pairs that agree better without the sweep.
  [[nodiscard]] std::size_t better(std::size_t sweep) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < given.size(); ++k) count += undone[sweep][k] > given[k] ? 1 : 0;
    return count;
  }
};

SkewFit fit_sweeps(const Samples& samples, const std::vector<ScanPair>& pairs,
                   const Sweeps& sweeps) {
  SkewFit fit;
  fit.undone.resize(sweeps.of(pairs.front().from).size());
  for (const ScanPair& pair : pairs) {
    const auto from_sweeps = sweeps.of(pair.from), to_sweeps = sweeps.of(pair.to);
    const auto from = passed_once(samples.surfels(pair.from), from_sweeps.front());
    const auto to = passed_once(samples.surfels(pair.to), to_sweeps.front());
    const Pose motion = samples.poses()[pair.from].inverse() * samples.poses()[pair.to];
    const Pose from_motion = motion_during(samples, pair.from);
    const Pose to_motion = motion_during(samples, pair.to);
    fit.given.push_back(registered(from, to, motion));
    for (std::size_t k = 0; k < fit.undone.size(); ++k) {
      fit.undone[k].push_back(registered(unskewed(from, from_motion, from_sweeps[k]),
                                         unskewed(to, to_motion, to_sweeps[k]), motion));
    }
  }
  return fit;
}

/// If the points of a scan are each in the frame that the sensor had when it took them, undoing
/// its motion makes far scans agree better, and undoing the opposite motion makes them worse; on
/// any other data both make them worse.
std::vector<Finding> look_for_skew(Samples& samples) {
  if (!pose_verdict(samples).check.empty()) return {};
  const std::vector<ScanPair> pairs = far_pairs(samples);
  if (pairs.size() < kFewestFarPairs) return {};
  const Sweeps sweeps(samples, pairs);
  const SkewFit fit = fit_sweeps(samples, pairs, sweeps);
  std::size_t best = 0;
  for (std::size_t k = 1; k < fit.undone.size(); ++k) {
    if (SkewFit::sum(fit.undone[k]) > SkewFit::sum(fit.undone[best])) best = k;
  }
  const std::size_t opposite = (best + fit.undone.size() / 2) % fit.undone.size();
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
  return {
      {.where = "points of all scans",
       .what = fmt::format("scans {} m apart agree {} % better if the sensor's motion is undone "
                           "within each (sweep {})",
                           fixed_text(kDistance, 0), fixed_text(100.0 * (gain - 1.0), 0),
                           sweeps.of(pairs.front().from)[best].text)}};
}

}  // namespace

std::vector<Check> skew_checks() {
  return {
      {"skewed-scans", "points are not corrected for the motion of the sensor during a scan",
       "all points of a scan in the sensor's frame at one time",
       "If points have times, say --deskew. Else correct each point with the motion between its "
       "time and that of the scan (deskewing, as LiDAR odometry programs do).",
       look_for_skew}};
}

}  // namespace raymoval::inspection
