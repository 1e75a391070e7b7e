// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/pose_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/evidence/pair_fit.h"
#include "datasets/inspection/evidence/pose_hypotheses.h"
#include "datasets/inspection/evidence/time_offset.h"

namespace raymoval::inspection {
namespace {

/// Share of the best agreement that good poses reach. With a drift of 10 cm between the scans of a
/// pair, the share is higher.
constexpr double kGood = 0.65;
/// Metres from scan to scan beyond which registration is not enough to contradict the poses.
constexpr double kFarApart = 8.0;
/// Share that a hypothesis must reach, and its least advantage over the given poses.
constexpr double kNamed = 0.65;
constexpr double kBetter = 0.15;
/// Below this share, and with no hypothesis that explains it, poses and scans do not belong
/// together.
constexpr double kForeign = 0.5;
/// A simpler hypothesis, with fewer fitted parameters, is preferred if its share is lower by at
/// most this.
constexpr double kSimpler = 0.03;

/// Share of all planes that lie in the fullest half metre beyond 0.3 m along the axis of `group`,
/// times `sign`; `beyond` is the share farther out.
double fullest_level(const Samples& samples, Surfel::Group group, double sign, double& beyond) {
  constexpr double kLevel = 0.5, kNearest = 0.3;
  std::map<int, std::size_t> levels;
  std::size_t planes = 0;
  for (const auto& [index, scan] : samples.scans()) {
    for (const Surfel& surfel : samples.surfels(index)) {
      if (surfel.is_line() || surfel.mean.norm() > 20.0) continue;
      ++planes;
      const double level = sign * surfel.mean[static_cast<Eigen::Index>(group)];
      if (surfel.group == group && level > kNearest) ++levels[static_cast<int>(level / kLevel)];
    }
  }
  if (levels.empty()) return 0.0;
  const auto fullest =
      std::max_element(levels.begin(), levels.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  std::size_t far = 0;
  for (const auto& [level, count] : levels) far += level > fullest->first + 1 ? count : 0;
  beyond = static_cast<double>(far) / static_cast<double>(planes);
  return static_cast<double>(fullest->second) / static_cast<double>(planes);
}

/// Extent of the points of all scans along `axis`, without a twentieth at either end.
double extent(const Samples& samples, Eigen::Index axis) {
  std::vector<float> values;
  for (const auto& [index, scan] : samples.scans()) {
    for (std::size_t i = 0; i < scan.size(); i += 50) values.push_back(scan.points[i][axis]);
  }
  std::sort(values.begin(), values.end());
  const std::size_t twentieth = values.size() / 20;
  return static_cast<double>(values[values.size() - 1 - twentieth] - values[twentieth]);
}

/// Whether the ground is along +y, as in camera axes, and not along -z. With few beams (VLP-16) and
/// long walls, there is no plane of ground; but then the scan is wide along y.
bool in_camera_axes(Samples& samples) {
  double beyond_y = 0.0, beyond_z = 0.0;
  const double y = fullest_level(samples, Surfel::Group::kNormalY, 1.0, beyond_y);
  const double z = fullest_level(samples, Surfel::Group::kNormalZ, -1.0, beyond_z);
  samples.measures.emplace_back("ground_along_minus_z", z);
  samples.measures.emplace_back("ground_along_y", y);
  if (y < 0.1 || y < 3.0 * z || beyond_y > 0.1) return false;
  return extent(samples, 1) < 0.7 * extent(samples, 2);
}

/// Distinguishes points in camera axes from poses of a camera, which have the same motions. If
/// points and poses are both in camera axes, they fit each other, and there is no defect.
void look_at_axes(Samples& samples, PoseVerdict& verdict) {
  if (verdict.check != "lidar-poses-as-camera" || !in_camera_axes(samples)) return;
  verdict.what =
      "the ground lies along +y of the points: they are in camera axes (x right, y down, z ahead), "
      "but the poses do not";
  verdict.check = "camera-frame";
}

/// Whether the points move along with the poses, like points in the world frame. Traffic of the
/// same speed and the ego vehicle agree without poses, but stay around the origin.
bool points_follow_poses(const Samples& samples) {
  constexpr double kFewest = 2.0;
  const auto& first = samples.scans().begin()->second;
  const auto& last = samples.scans().rbegin()->second;
  const Eigen::Vector3d way =
      last.T_world_sensor.translation() - first.T_world_sensor.translation();
  const Eigen::Vector3d moved = middle_of(last) - middle_of(first);
  return way.norm() >= kFewest && (moved - way).norm() < 0.5 * way.norm();
}

bool is_identity(const PoseHypothesis& hypothesis) {
  return hypothesis.check == "points-in-world" || hypothesis.check == "viewpoint-twice";
}

/// A hypothesis and its share.
struct Reached {
  PoseHypothesis hypothesis;
  double share = 0.0;
};

/// The hypothesis under which the scans agree best.
Reached best_of(const Samples& samples, const PairFit& fit,
                const std::vector<PoseHypothesis>& hypotheses) {
  const bool in_world = points_follow_poses(samples);
  Reached best;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    if (is_identity(hypothesis) && !in_world) continue;
    const double share = fit.share(hypothesis.pose);
    if (share > best.share) best = {hypothesis, share};
  }
  return best;
}

/// The hypotheses that the sensor is turned on a body whose poses are `poses`, the simplest turn
/// first.
std::vector<PoseHypothesis> turned_on_body(const std::vector<Pose>& poses,
                                           const std::vector<RegisteredMotion>& seen) {
  std::vector<PoseHypothesis> all;
  if (!turns_as_much(poses, seen)) return all;
  for (const Pose& mount : mounts_on_body(poses, seen)) {
    PoseHypothesis hypothesis{"poses-of-a-body",
                              "if the sensor is turned by " + turn_text(mount.linear()) +
                                  " on the body that has the poses",
                              [poses, mount](std::size_t i) { return Pose(poses[i] * mount); },
                              "--T-sensor " + mounting_text(mount) + "."};
    if (mount.translation().isZero()) {
      hypothesis.remedy +=
          " The sensor turns too little to estimate its position on the body; replace the zeros "
          "if you know it.";
    }
    all.push_back(std::move(hypothesis));
  }
  return all;
}

/// Poses of a body on which the sensor is turned: as they are given, or misread.
std::vector<PoseHypothesis> body_hypotheses(Samples& samples,
                                            const std::vector<RegisteredMotion>& seen) {
  const std::optional<Pose>& T_body_sensor = samples.sequence().T_body_sensor;
  const bool of_camera = samples.sequence().T_camera_lidar.has_value();
  std::vector<PoseHypothesis> all = turned_on_body(samples.poses(), seen);
  for (PoseHypothesis& hypothesis : all) {
    const std::string option = std::exchange(hypothesis.remedy, "");
    if (T_body_sensor) {
      hypothesis.remedy = "Multiply the pose of --T-sensor from the right by the pose of " + option;
    } else if (!of_camera) {
      hypothesis.remedy = "Use " + option;
    }
  }
  if (of_camera) return all;
  for (const MisreadPoses& read : misread_poses(samples)) {
    std::vector<Pose> poses = samples.poses();
    for (Pose& pose : poses) {
      pose = read.right(T_body_sensor ? Pose(pose * T_body_sensor->inverse()) : pose);
    }
    for (PoseHypothesis& hypothesis : turned_on_body(poses, seen)) {
      hypothesis.check = read.check;
      hypothesis.phrase = read.phrase + " and " + hypothesis.phrase;
      hypothesis.remedy = "Use " + read.option + " " + hypothesis.remedy;
      all.push_back(std::move(hypothesis));
    }
  }
  return all;
}

/// Poses of other times; it says nothing where the scans do not tell.
std::optional<PoseHypothesis> time_hypothesis(Samples& samples) {
  const auto offset = find_time_offset(samples);
  if (!offset || !is_clear(*offset)) return std::nullopt;
  PoseHypothesis hypothesis{
      "poses-of-another-time", "with the poses of " + time_offset_option(samples, *offset),
      [&samples, offset = *offset](std::size_t i) { return pose_with(samples, offset, i); }};
  hypothesis.remedy = "Use " + time_offset_option(samples, *offset) + ".";
  return hypothesis;
}

/// The hypothesis that explains the scans best. Two kinds are fitted to the scans (the rotation of
/// a sensor on a body, a time offset); another one is preferred if it is nearly as good.
Reached best_hypothesis(Samples& samples, const PairFit& fit,
                        std::vector<PoseHypothesis> hypotheses) {
  const std::vector<RegisteredMotion> seen = fit.registered_motions();
  std::vector<PoseHypothesis> fitted = body_hypotheses(samples, seen);
  if (auto time = time_hypothesis(samples)) {
    std::erase_if(hypotheses, [](const auto& other) { return other.check == "poses-shifted"; });
    fitted.push_back(std::move(*time));
  }
  Reached best = best_of(samples, fit, hypotheses);
  for (const PoseHypothesis& hypothesis : fitted) {
    const double share = fit.share(hypothesis.pose);
    if (share > best.share + kSimpler) best = {hypothesis, share};
  }
  return best;
}

/// The largest of 100, 10, 1 and 0.1 m of which all positions along an axis that is far from the
/// origin are multiples; 0 if there is none.
double position_step(const std::vector<Pose>& poses) {
  constexpr double kFar = 1000.0, kLargest = 100.0, kSmallest = 0.05;
  double found = 0.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double step = kLargest, farthest = 0.0;
    for (const Pose& pose : poses) {
      const double at = pose.translation()[axis];
      farthest = std::max(farthest, std::abs(at));
      while (step > kSmallest && std::abs(at / step - std::round(at / step)) > 1e-6) step /= 10.0;
    }
    if (farthest > kFar && step > kSmallest) found = std::max(found, step);
  }
  return found;
}

registration::PoseFit fit_of_given(const Samples& samples) {
  return registration::measure_pose_fit(*samples.sequence().scans, samples.threads(),
                                        samples.cancel());
}

/// Keeps a fit for `measured_fit`.
void keep_fit(const registration::PoseFit& fit, Samples& samples) {
  samples.pose_fit = fit;
  samples.measures.emplace_back("pose_fit_pairs", static_cast<double>(fit.pairs.size()));
  if (fit.pairs.empty()) return;
  samples.measures.emplace_back("pose_fit_m", fit.distance_m);
  samples.measures.emplace_back("pose_fit_worst_m", worst_pair(fit).distance_m);
  samples.measures.emplace_back("pose_fit_noise_m", fit.noise_m);
}

/// Whether enough surfaces lie within centimetres of each other under the given poses.
bool fit_each_other(Samples& samples) {
  const registration::PoseFit fit = fit_of_given(samples);
  if (fit.pairs.empty() || !registration::fits(fit)) return false;
  keep_fit(fit, samples);
  return true;
}

PoseVerdict compare_hypotheses(Samples& samples) {
  if (samples.pairs().empty()) return {};
  PairFit fit(samples);
  fit.find_best({});
  const auto given_pose = [&](std::size_t i) { return samples.poses()[i]; };
  double given = fit.share(given_pose);
  samples.measures.emplace_back("agreement", fit.mean_best());
  samples.measures.emplace_back("agreement_of_given_poses", given);
  if (fit.is_informative() && given >= kGood) return {};

  const std::vector<PoseHypothesis> hypotheses = pose_hypotheses(samples);
  fit.find_best(hypotheses);
  given = fit.share(given_pose);
  if (!fit.is_informative() || given >= kGood) return {};
  const auto [best, reached] = best_hypothesis(samples, fit, hypotheses);
  samples.measures.emplace_back("agreement_of_best_hypothesis", reached);
  const std::string now = "the scans fit to " + percent_text(given) + " under the poses";
  if (reached >= kNamed && reached > given + kBetter) {
    return {best.check, now + " and to " + percent_text(reached) + " " + best.phrase, best.remedy};
  }
  if (const double step = position_step(samples.poses()); step > 0.0) {
    return {"poses-coarse",
            now + ", whose positions are whole multiples of " + number_text(step) +
                " m along an axis: written far from the origin with too few digits"};
  }
  if (given >= kForeign || !fit.contradict(given_pose) || fit.poles_prefer(given_pose)) return {};
  // At 2 Hz on a motorway few surfels are common, and parallel structures register best.
  if (samples.median_step() > kFarApart && fit_each_other(samples)) return {};
  return {"poses-of-another-sequence",
          now +
              " (100 % = registered to each other), and under no usual mistake of frames, units or "
              "order to more than " +
              percent_text(reached)};
}

}  // namespace

Eigen::Vector3d middle_of(const Scan& scan) {
  Eigen::Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (std::size_t i = 0; i < scan.size(); i += 10) values.push_back(scan.points[i][axis]);
    middle[axis] = static_cast<double>(median(std::move(values)));
  }
  return middle;
}

bool has_one_viewpoint(const Samples& samples) {
  if (!samples.points_in_world()) return false;
  constexpr double kLeast = 1.0, kLeastShare = 0.25;  // metres, and of the median range
  const auto& poses = samples.poses();
  const bool equal = std::all_of(poses.begin(), poses.end(), [&](const Pose& pose) {
    return pose.matrix() == poses.front().matrix();
  });
  if (!equal) return false;
  const Eigen::Vector3d first = middle_of(samples.scans().begin()->second);
  return std::any_of(samples.scans().begin(), samples.scans().end(), [&](const auto& scan) {
    return (middle_of(scan.second) - first).norm() >
           std::max(kLeast, kLeastShare * samples.median_range());
  });
}

bool can_measure_fit(Samples& samples) {
  return samples.size() > 1 && samples.point_scale() == 1.0 && pose_verdict(samples).check.empty();
}

const registration::PoseFit& measured_fit(Samples& samples) {
  if (samples.pose_fit) return *samples.pose_fit;
  if (!can_measure_fit(samples)) return samples.pose_fit.emplace();
  // The verdict on the poses may have measured it.
  if (!samples.pose_fit) keep_fit(fit_of_given(samples), samples);
  return *samples.pose_fit;
}

const PoseVerdict& pose_verdict(Samples& samples) {
  if (!samples.pose_verdict) {
    PoseVerdict verdict = compare_hypotheses(samples);
    look_at_axes(samples, verdict);
    samples.pose_verdict = verdict;
  }
  return *samples.pose_verdict;
}

}  // namespace raymoval::inspection
