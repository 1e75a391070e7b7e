// SPDX-License-Identifier: MIT
#include "datasets/odometry/estimate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "core/angle.h"
#include "core/error.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/odometry/pose_graph.h"
#include "datasets/registration/pose_fit.h"
#include "datasets/registration/reposed_source.h"

namespace raymoval::odometry {
namespace {

constexpr double kMostUncertain = 0.4;  // Of the scans of an estimate.
constexpr double kAtRest = 0.05;        // metres
constexpr double kTurnAtRest = 0.5 * kDegree;
constexpr MotionSigma kStepSigma{0.005, 0.0005};  // Of odometry from scan to scan.
constexpr MotionSigma kFreeSigma{0.3, 0.02};      // The same where it is not determined.
/// Of given poses: weak enough that a jump of 2 m does not bend hundreds of scans.
constexpr MotionSigma kGivenSigma{5.0, 0.25};
/// Difference of overlaps: below it two motions fit equally, and above it one fits clearly better.
constexpr double kEqual = 0.008, kClear = 0.01;
constexpr double kPoorFit = 0.5;  // Of the median; scans of good estimates reach 0.68.
constexpr std::size_t kFewestSearched = 4, kScansPerSearch = 150, kMostSearches = 6;

/// The scale of the middle scan, or of the next that has a point.
ScanScale scale_of(const ScanSource& scans) {
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const Scan scan = scans.load((scans.size() / 2 + k) % scans.size());
    if (scan.size() > 0) return odometry::scale_of(scan);
  }
  throw DataError("no scan has a point, so poses cannot be estimated. Take other scans.");
}

bool is_uncertain(const Registered& scan) {
  return !scan.determined;
}

/// The motions from scan to scan.
std::vector<GraphEdge> step_edges(const Steps& steps, const std::vector<Pose>* given) {
  std::vector<GraphEdge> edges;
  for (std::size_t i = 1; i < steps.scans.size(); ++i) {
    const Registered& scan = steps.scans[i];
    GraphEdge edge{i - 1, i, steps.scans[i - 1].T_map_sensor.inverse() * scan.T_map_sensor,
                   scan.determined ? kStepSigma : kFreeSigma};
    if (given != nullptr && (is_lost(scan) || is_uncertain(scan))) {
      edge.T_from_to = (*given)[i - 1].inverse() * (*given)[i];
      edge.sigma = kFreeSigma;
    }
    edges.push_back(edge);
  }
  return edges;
}

/// "000012 to 000034, 000051": the scans for which `is_one` is true.
template <class IsOne>
std::string ranges_text(const Steps& steps, IsOne&& is_one) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < steps.scans.size(); ++i) {
    if (!is_one(steps.scans[i])) continue;
    std::size_t last = i;
    while (last + 1 < steps.scans.size() && is_one(steps.scans[last + 1])) ++last;
    ranges.push_back(steps.names[i] + (last > i ? " to " + steps.names[last] : ""));
    i = last;
  }
  constexpr std::size_t kMost = 4;
  const std::size_t more = ranges.size() > kMost ? ranges.size() - kMost : 0;
  ranges.resize(ranges.size() - more);
  return join(ranges) + (more > 0 ? " and " + counted_text(more, "other range") : "");
}

std::size_t count_uncertain(const Steps& steps) {
  return static_cast<std::size_t>(
      std::count_if(steps.scans.begin(), steps.scans.end(), is_uncertain));
}

/// "The poses of 5 scans are uncertain: ..."; there is at least one.
std::string uncertain_text(const Steps& steps) {
  return fmt::format(
      "The poses of {} are uncertain: the surfaces do not determine the motion in every direction, "
      "as in a corridor, on open land or in a narrow view of the ground (scans {}).",
      counted_text(count_uncertain(steps), "scan"), ranges_text(steps, is_uncertain));
}

/// Refuses poses that would mostly be guesses.
void check_certain(const Steps& steps) {
  const auto share =
      static_cast<double>(count_uncertain(steps)) / static_cast<double>(steps.scans.size());
  if (share <= kMostUncertain) return;
  throw DataError(uncertain_text(steps) +
                  " These are too many to estimate poses. Take the poses of a program that also "
                  "uses an IMU or odometry: --poses FILE.");
}

void warn_of_uncertain(const Steps& steps, std::vector<std::string>& warnings) {
  if (count_uncertain(steps) > 0) {
    warnings.push_back(uncertain_text(steps) + " There the motion before continues.");
  }
  for (std::size_t i = 1; i < steps.times.size(); ++i) {
    const double gap = steps.times[i] - steps.times[i - 1];
    if (gap < kLongGap) continue;
    warnings.push_back(fmt::format(
        "There is no scan for {} s between {} and {}; their motion is estimated across the gap.",
        fixed_text(gap, 1), steps.names[i - 1], steps.names[i]));
  }
}

bool is_at_rest(const std::vector<Pose>& poses) {
  return std::all_of(poses.begin(), poses.end(), [&](const Pose& pose) {
    const Pose motion = poses.front().inverse() * pose;
    return motion.translation().norm() < kAtRest &&
           Eigen::AngleAxisd(motion.linear()).angle() < kTurnAtRest;
  });
}

/// Closes loops: the poses that fit `edges` and the returns to a place.
std::vector<Pose> with_loops(const MovingScans& input, const Steps& steps,
                             std::vector<GraphEdge> edges, std::vector<Pose> poses,
                             PoseEstimate& estimate) {
  const std::vector<GraphEdge> loops = find_loops(input, poses, steps.times);
  estimate.loops = loops.size();
  edges.insert(edges.end(), loops.begin(), loops.end());
  return loops.empty() ? poses : optimised(std::move(poses), edges);
}

/// Source without an owner, for a source that outlives it.
std::shared_ptr<const ScanSource> borrowed(const ScanSource& scans) {
  return {std::shared_ptr<const ScanSource>(), &scans};
}

registration::PoseFit fit_of(const MovingScans& input, const std::vector<Pose>& poses) {
  return registration::measure_pose_fit(ReposedSource(borrowed(input.scans), poses), input.threads,
                                        input.cancel);
}

std::string fit_text(const registration::PoseFit& fit) {
  if (fit.pairs.empty()) return "unknown";
  return fmt::format("{} m (worst pair {} m)", fixed_text(fit.distance_m, 3),
                     fixed_text(worst_pair(fit).distance_m, 3));
}

/// Distances between poses and the given ones, metres.
struct Moved {
  double median = 0.0, most = 0.0;
};

Moved moved_between(const std::vector<Pose>& poses, const std::vector<Pose>& given) {
  std::vector<double> moved;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    moved.push_back((poses[i].translation() - given[i].translation()).norm());
  }
  const double most = *std::max_element(moved.begin(), moved.end());
  return {median_in_place(moved), most};
}

/// Whether poses fit worse than others. If they moved far, the pairs are others, too: returns to a
/// place that the given poses do not show. Then a little more is allowed.
bool is_worse(const registration::PoseFit& fit, const registration::PoseFit& other,
              const Moved& moved) {
  constexpr double kFar = 0.1, kTolerance = 0.005;  // metres
  if (other.pairs.empty()) return false;
  if (fit.pairs.empty()) return true;
  if (fits(fit) && !fits(other)) return false;
  const double worst = worst_pair(fit).distance_m, other_worst = worst_pair(other).distance_m;
  if (moved.most <= kFar) return fit.distance_m >= other.distance_m && worst >= other_worst;
  return fit.distance_m > other.distance_m + kTolerance ||
         worst > std::max(other_worst, registration::kMostDistanceOfPair);
}

/// "scans 000000 to 000009 also fit a motion of 3.00 m from scan to scan, ...".
std::string doubt_text(const std::vector<std::string>& names, std::size_t begin,
                       const MotionSearch& search) {
  const auto metres = [](const TriedMotion& motion) {
    return fixed_text(motion.last.translation().norm(), 2) + " m";
  };
  return fmt::format(
      "scans {} to {} also fit a motion of {} from scan to scan, with an overlap of {}; with the "
      "{} of the poses it is {}",
      names[begin], names[std::min(begin + kSearchedScans, names.size()) - 1], metres(search.other),
      percent_text(search.other.overlap, 1), metres(search.given),
      percent_text(search.given.overlap, 1));
}

/// The motion from the first scan to the second under which the first scans fit best; empty if
/// there are too few scans to tell.
std::optional<Pose> better_start(const MovingScans& input, std::vector<std::string>& doubts) {
  const std::size_t count = std::min(kSearchedScans, input.scans.size());
  if (count < kFewestSearched) return std::nullopt;
  MovingScans quiet = input;
  quiet.progress = nullptr;
  const Steps steps = odometry_of(quiet, {count, std::nullopt, true}, nullptr);
  MotionSearch search = search_motion(input, 0, steps.poses());
  TriedMotion best = search.alike;
  if (search.advantage() > 0.0) {
    std::swap(search.given, search.other);
    best = search.given;
  }
  if (search.advantage() > -kEqual) doubts.push_back(doubt_text(steps.names, 0, search));
  return best.first;
}

/// Adds doubts where another motion fits clearly better than that of `poses`, and returns it.
std::optional<Pose> search_along(const MovingScans& input, const Steps& steps,
                                 const std::vector<Pose>& poses, std::vector<std::string>& doubts) {
  std::optional<Pose> better;
  if (poses.size() < 2 * kSearchedScans) return better;
  const std::size_t most = std::min(2 + poses.size() / kScansPerSearch, kMostSearches);
  for (const std::size_t begin : evenly_spread(poses.size() - kSearchedScans + 1, most)) {
    if (begin == 0) continue;
    const auto first = poses.begin() + static_cast<std::ptrdiff_t>(begin);
    const MotionSearch search = search_motion(input, begin, {first, first + kSearchedScans});
    if (search.advantage() <= kClear) continue;
    doubts.push_back(doubt_text(steps.names, begin, search));
    if (!better) better = search.other.first;
  }
  return better;
}

/// Adds a doubt if scans after the second fit much worse than most, as after a turn that was too
/// fast.
void doubt_poor_fits(const Steps& steps, std::vector<std::string>& doubts) {
  if (steps.scans.size() <= kFewestSearched) return;
  std::vector<double> fits;
  for (std::size_t i = 2; i < steps.scans.size(); ++i) fits.push_back(steps.scans[i].fit());
  const double least = *std::min_element(fits.begin(), fits.end());
  const double usual = median_in_place(fits);
  if (least >= kPoorFit * usual) return;
  const auto is_poor = [&](const Registered& scan) {
    return &scan > &steps.scans[1] && scan.fit() < kPoorFit * usual;
  };
  doubts.push_back(fmt::format(
      "only {} of the points of some scans lie on surfaces of the scans before them, compared with "
      "{} in most (scans {})",
      percent_text(least), percent_text(usual), ranges_text(steps, is_poor)));
}

/// An estimate that begins with a motion.
struct Attempt {
  Steps steps;
  PoseEstimate estimate;
  std::optional<Pose> better_motion;  ///< If one fits clearly better than that of the poses.
};

Attempt attempt(const MovingScans& input, const Course& course) {
  Attempt made{odometry_of(input, course, nullptr), {}, {}};
  made.estimate.poses = with_loops(input, made.steps, step_edges(made.steps, nullptr),
                                   made.steps.poses(), made.estimate);
  made.better_motion = search_along(input, made.steps, made.estimate.poses, made.estimate.doubts);
  doubt_poor_fits(made.steps, made.estimate.doubts);
  return made;
}

/// The estimate from the motion with which the first scans fit best, or, if later scans fit another
/// motion better, from that one.
Attempt best_attempt(const MovingScans& input) {
  std::vector<std::string> doubts;
  const std::size_t count = input.scans.size();
  Attempt best = attempt(input, {count, better_start(input, doubts)});
  if (best.better_motion) {
    Attempt other = attempt(input, {count, best.better_motion, true});
    const auto& scans = other.steps.scans;
    if (!other.better_motion && std::none_of(scans.begin(), scans.end(), is_lost)) return other;
  }
  best.estimate.doubts.insert(best.estimate.doubts.begin(), doubts.begin(), doubts.end());
  return best;
}

}  // namespace

PoseEstimate estimate_poses(MovingScans input) {
  if (input.scans.size() == 0) return {};
  if (!(input.scale.cell > 0.0)) input.scale = scale_of(input.scans);
  auto [steps, estimate, better_motion] = best_attempt(input);
  check_certain(steps);
  if (is_at_rest(estimate.poses)) {
    estimate.warnings.push_back(
        "The sensor was at rest, or all that it sees moves along with it: the estimated poses "
        "differ by less than 0.05 m and 0.5 degrees.");
  } else {
    estimate.summary =
        fmt::format("The poses are estimated from the scans: a path of {} m with {}.",
                    fixed_text(registration::path_lengths(estimate.poses).back(), 1),
                    counted_text(estimate.loops, "closed loop"));
  }
  warn_of_uncertain(steps, estimate.warnings);
  return estimate;
}

PoseEstimate refine_poses(MovingScans input, const std::vector<Pose>& given) {
  PoseEstimate estimate;
  if (input.scans.size() == 0) return estimate;
  if (!(input.scale.cell > 0.0)) input.scale = scale_of(input.scans);
  const Steps steps = odometry_of(input, {input.scans.size(), std::nullopt, true}, &given);
  std::vector<GraphEdge> edges = step_edges(steps, &given);
  for (std::size_t i = 0; i < given.size(); ++i) {
    edges.push_back({std::nullopt, i, given[i], kGivenSigma, true});
  }
  std::vector<Pose> poses;
  for (const Pose& pose : steps.poses()) poses.push_back(given.front() * pose);
  poses = optimised(std::move(poses), edges);
  poses = with_loops(input, steps, std::move(edges), std::move(poses), estimate);
  const registration::PoseFit before = fit_of(input, given), after = fit_of(input, poses);
  const Moved moved = moved_between(poses, given);
  const std::string change =
      "from " + fit_text(before) + " to " + fit_text(after) + " between overlapping scans";
  if (is_worse(after, before, moved)) {
    estimate.poses = given;
    estimate.warnings.push_back("The given poses are kept: refined poses would fit worse, " +
                                change + ".");
    return estimate;
  }
  estimate.summary = fmt::format(
      "The poses are refined: moved by a median of {} m and at most {} m, with {}. They fit {}.",
      fixed_text(moved.median, 3), fixed_text(moved.most, 3),
      counted_text(estimate.loops, "closed loop"), change);
  estimate.poses = std::move(poses);
  warn_of_uncertain(steps, estimate.warnings);
  return estimate;
}

}  // namespace raymoval::odometry
