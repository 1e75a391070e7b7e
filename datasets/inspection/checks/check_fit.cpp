// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pair_fit.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/inspection/evidence/pose_hypotheses.h"
#include "datasets/inspection/evidence/time_offset.h"
#include "datasets/registration/reposed_source.h"

namespace raymoval::inspection {
namespace {

using registration::PairDistance;
using registration::PoseFit;

/// Largest share of the distance that remains under a hypothesis that explains it.
constexpr double kExplained = 0.25;

bool is_wrong(const PairDistance& pair) {
  return pair.distance_m > registration::kMostDistanceOfPair;
}

/// If all wrong pairs span one jump: the last scan before it and the first scan after it.
std::optional<PairDistance> find_jump(const ScanSource& scans, const PoseFit& fit) {
  std::optional<PairDistance> jump;
  for (const PairDistance& pair : fit.pairs) {
    if (!is_wrong(pair)) continue;
    if (!jump) jump = pair;
    jump->from = std::max(jump->from, pair.from);
    jump->to = std::min(jump->to, pair.to);
  }
  if (!jump || jump->from >= jump->to) return std::nullopt;
  while (jump->to - jump->from > 1) {
    const std::size_t middle = jump->from + (jump->to - jump->from) / 2;
    const bool before =
        registration::measure_pair(scans, jump->from, middle) > 0.5 * jump->distance_m;
    (before ? jump->to : jump->from) = middle;
  }
  return jump;
}

/// Frames on the longer side of a jump.
std::string frames_beside(const Samples& samples, const PairDistance& jump) {
  const bool before = jump.from + 1 >= samples.size() - jump.to;
  return before ? samples.frame_name(0) + ":" + samples.frame_name(jump.from)
                : samples.frame_name(jump.to) + ":" + samples.frame_name(samples.size() - 1);
}

std::string remedy_of(const Samples& samples, const PoseFit& fit) {
  std::string improve =
      "Estimate the poses again with a SLAM program that closes loops (docs/poses.md names some).";
  if (!samples.sequence().topics.empty()) {
    improve += " If each topic alone fits, the place of one sensor beside the other is wrong.";
  }
  if (fit.distance_m > registration::kMostDistance) return improve;
  const auto jump = find_jump(*samples.sequence().scans, fit);
  if (!jump) return improve;
  return fmt::format(
      "The poses jump between frames {} and {}: clean each side by itself (--frames {}). {}",
      samples.frame_name(jump->from), samples.frame_name(jump->to), frames_beside(samples, *jump),
      improve);
}

/// Tries the hypotheses on poses again: similar scans along a street agree under wrong poses, too,
/// but do not fit to the centimetre. Hypotheses under which scans agree less are left out.
std::optional<Finding> explained(Samples& samples, const PoseFit& given) {
  PairFit agreement(samples);
  agreement.find_best({});
  const double least = agreement.share([&](std::size_t i) { return samples.poses()[i]; });
  for (const PoseHypothesis& hypothesis : pose_hypotheses(samples)) {
    if (agreement.share(hypothesis.pose) < least) continue;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < samples.size(); ++i) poses.push_back(hypothesis.pose(i));
    const ReposedSource scans(samples.sequence().scans, std::move(poses));
    const PoseFit fit = registration::measure_pose_fit(scans, samples.threads(), samples.cancel());
    if (!fits(fit) || fit.distance_m > kExplained * given.distance_m ||
        10 * fit.pairs.size() < 9 * given.pairs.size()) {
      continue;
    }
    const Check& check = check_named(hypothesis.check);
    return Finding{.check = check.name,
                   .what = fmt::format("{}, and to {} m {}", pose_fit_text(samples),
                                       fixed_text(fit.distance_m, 3), hypothesis.phrase),
                   .expected = check.expected,
                   .remedy = hypothesis.remedy.empty() ? check.remedy : hypothesis.remedy};
  }
  return std::nullopt;
}

std::vector<Finding> look_at_fit(Samples& samples) {
  const PoseFit& fit = measured_fit(samples);
  if (fits(fit)) return {};
  if (const auto offset = find_time_offset(samples); offset && is_clear(*offset)) {
    return {{.check = "time-offset",
             .what = pose_fit_text(samples) + "; " + time_offset_text(*offset),
             .expected = check_named("time-offset").expected,
             .remedy = "Use " + time_offset_option(samples, *offset) + "."}};
  }
  if (const auto finding = explained(samples, fit)) return {*finding};
  const auto wrong = std::count_if(fit.pairs.begin(), fit.pairs.end(), is_wrong);
  return {{.what = pose_fit_text(samples) + "; " +
                   counted_text(static_cast<std::size_t>(wrong), "pair") + " above " +
                   fixed_text(registration::kMostDistanceOfPair, 2) + " m",
           .remedy = remedy_of(samples, fit)}};
}

std::vector<Finding> look_at_doubts(Samples& samples) {
  std::vector<Finding> findings;
  for (const std::string& doubt : samples.sequence().pose_doubts) {
    findings.push_back({.what = doubt});
  }
  return findings;
}

}  // namespace

std::string pose_fit_text(const Samples& samples) {
  const PoseFit& fit = *samples.pose_fit;
  if (fit.pairs.empty()) return "no two scans overlap enough to measure how well poses fit";
  const PairDistance& worst = worst_pair(fit);
  return fmt::format(
      "poses fit to {} m (median of {} of overlapping scans; worst {} m, frames {} and {}; noise "
      "of the sensor {} m)",
      fixed_text(fit.distance_m, 3), counted_text(fit.pairs.size(), "pair"),
      fixed_text(worst.distance_m, 3), samples.frame_name(worst.from), samples.frame_name(worst.to),
      fixed_text(fit.noise_m, 3));
}

std::vector<Check> fit_checks() {
  return {{"poses-do-not-fit", "surfaces of overlapping scans lie apart under the poses",
           fmt::format("surfaces that lie within {} m of each other, and within {} m in every pair",
                       fixed_text(registration::kMostDistance, 2),
                       fixed_text(registration::kMostDistanceOfPair, 2)),
           "Estimate the poses again with a SLAM program that closes loops.", look_at_fit,
           Consequence::kRefused},
          {"motion-uncertain", "scans fit another motion than that of the estimated poses, or none",
           "scans that fit one motion of the sensor, and better than any other",
           "Compare the path with the drive. If it is wrong, take scans at a higher rate, or the "
           "poses of a program that also uses an IMU: --poses FILE.",
           look_at_doubts, Consequence::kRefused}};
}

}  // namespace raymoval::inspection
