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
#include "core/parallel.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/odometry/odometry.h"
#include "datasets/registration/pose_fit.h"
#include "datasets/registration/reposed_source.h"

namespace raymoval::odometry {
namespace {

/// Of a scan that overlaps with the scans before it (see `Registered`).
constexpr double kLeastMatched = 0.15, kLeastOverlap = 0.4;
constexpr double kMostUncertain = 0.4;  // Of the scans of an estimate.
constexpr double kLongGap = 1.0;        // seconds
constexpr double kAtRest = 0.05;        // metres
constexpr double kTurnAtRest = 0.5 * kDegree;
constexpr MotionSigma kStepSigma{0.005, 0.0005};  // Of odometry from scan to scan.
constexpr MotionSigma kFreeSigma{0.3, 0.02};      // The same where it is not determined.
/// Of given poses: weak enough that a jump of 2 m does not bend hundreds of scans.
constexpr MotionSigma kGivenSigma{5.0, 0.25};
constexpr std::size_t kScansAtOnce = 8;

double median_range_of(const ScanSource& scans) {
  std::vector<float> ranges;
  for (std::size_t k = 0; k < scans.size() && ranges.empty(); ++k) {
    const std::size_t i = (scans.size() / 2 + k) % scans.size();
    for (const Eigen::Vector3f& point : scans.load(i).points) ranges.push_back(point.norm());
  }
  if (!ranges.empty()) return median_in_place(ranges);
  throw DataError("no scan has a point, so poses cannot be estimated. Take other scans.");
}

/// The result of odometry.
struct Steps {
  std::vector<Registered> scans;
  std::vector<double> times;
  std::vector<std::string> names;

  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> poses;
    for (const Registered& scan : scans) poses.push_back(scan.T_map_sensor);
    return poses;
  }
};

bool is_lost(const Registered& scan) {
  return scan.matched < kLeastMatched || scan.overlap < kLeastOverlap;
}

bool is_uncertain(const Registered& scan) {
  return !scan.determined;
}

std::string percent_text(double share) {
  return fixed_text(100.0 * share, 0) + " %";
}

[[noreturn]] void throw_lost(const Steps& steps) {
  const std::size_t now = steps.scans.size() - 1;
  const double apart = steps.times[now] - steps.times[now - 1];
  const std::string gap = apart < kLongGap ? ""
                                           : " It was taken " + fixed_text(apart, 1) +
                                                 " s after scan " + steps.names[now - 1] + ".";
  throw DataError(fmt::format(
      "scan {}: does not overlap enough with the scans before it to estimate its pose: {} of its "
      "points are near their surfaces (expected at least {}), and {} of these are on them (at "
      "least {}).{} Estimate the scans before and after it by themselves (--frames), or take the "
      "poses of a program that also uses an IMU: --poses FILE.",
      steps.names[now], percent_text(steps.scans[now].matched), percent_text(kLeastMatched),
      percent_text(steps.scans[now].overlap), percent_text(kLeastOverlap), gap));
}

/// Runs odometry over all scans. Scans are read in parallel, some at a time.
/// @param given null, or poses whose motions are a second guess
Steps odometry_of(const MovingScans& input, const std::vector<Pose>* given) {
  Odometry odometry(input.median_range);
  Steps steps;
  const std::size_t count = input.scans.size();
  if (input.progress != nullptr) input.progress->begin("estimating poses", count);
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kScansAtOnce == 0) {
      scans.assign(std::min(kScansAtOnce, count - i), {});
      parallel_for(input.threads, scans.size(), 1,
                   [&](std::size_t k) { scans[k] = input.scans.load(i + k); });
    }
    if (input.cancel != nullptr && input.cancel->load()) throw Cancelled();
    const Scan& scan = scans[i % kScansAtOnce];
    std::optional<Pose> hint;
    if (given != nullptr && i > 0) hint = (*given)[i - 1].inverse() * (*given)[i];
    steps.times.push_back(scan.time_s);
    steps.names.push_back(scan.name);
    steps.scans.push_back(odometry.add(
        scan, input.point_times ? input.point_times(scan) : std::vector<double>(), hint));
    if (given == nullptr && is_lost(steps.scans.back())) throw_lost(steps);
    if (input.progress != nullptr) input.progress->advance();
  }
  if (input.progress != nullptr) input.progress->end();
  return steps;
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

void note_uncertain(const Steps& steps, std::vector<std::string>& notes) {
  if (count_uncertain(steps) > 0) {
    notes.push_back(uncertain_text(steps) + " There the motion before continues.");
  }
  for (std::size_t i = 1; i < steps.times.size(); ++i) {
    const double gap = steps.times[i] - steps.times[i - 1];
    if (gap < kLongGap) continue;
    notes.push_back(fmt::format(
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

double path_length(const std::vector<Pose>& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return length;
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

}  // namespace

PoseEstimate estimate_poses(MovingScans input) {
  PoseEstimate estimate;
  if (input.scans.size() == 0) return estimate;
  if (!(input.median_range > 0.0)) input.median_range = median_range_of(input.scans);
  const Steps steps = odometry_of(input, nullptr);
  check_certain(steps);
  estimate.poses = with_loops(input, steps, step_edges(steps, nullptr), steps.poses(), estimate);
  if (is_at_rest(estimate.poses)) {
    estimate.notes.push_back(
        "The sensor was at rest, or all that it sees moves along with it: the estimated poses "
        "differ by less than 0.05 m and 0.5 degrees.");
  } else {
    estimate.notes.push_back(fmt::format(
        "The poses are estimated from the scans: a path of {} m with {}.",
        fixed_text(path_length(estimate.poses), 1), counted_text(estimate.loops, "closed loop")));
  }
  note_uncertain(steps, estimate.notes);
  return estimate;
}

PoseEstimate refine_poses(MovingScans input, const std::vector<Pose>& given) {
  PoseEstimate estimate;
  if (input.scans.size() == 0) return estimate;
  if (!(input.median_range > 0.0)) input.median_range = median_range_of(input.scans);
  const Steps steps = odometry_of(input, &given);
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
    estimate.notes.push_back("The given poses are kept: refined poses would fit worse, " + change +
                             ".");
    return estimate;
  }
  estimate.notes.push_back(fmt::format(
      "The poses are refined: moved by a median of {} m and at most {} m, with {}. They fit {}.",
      fixed_text(moved.median, 3), fixed_text(moved.most, 3),
      counted_text(estimate.loops, "closed loop"), change));
  estimate.poses = std::move(poses);
  note_uncertain(steps, estimate.notes);
  return estimate;
}

}  // namespace raymoval::odometry
