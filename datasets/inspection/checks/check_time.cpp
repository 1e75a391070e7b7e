// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/sampling.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/inspection/evidence/time_offset.h"

namespace raymoval::inspection {
namespace {

std::string between(const Samples& samples, std::size_t scan) {
  return "frames " + samples.frame_name(scan) + " to " + samples.frame_name(scan + 1);
}

std::string and_more(std::size_t count) {
  return count > 1 ? ", and " + grouped_text(count - 1) + " more like it" : "";
}

std::vector<double> periods(const Samples& samples) {
  std::vector<double> all;
  for (std::size_t i = 1; i < samples.files().size(); ++i) {
    all.push_back(samples.files()[i].time_s - samples.files()[i - 1].time_s);
  }
  return all;
}

std::vector<Finding> look_for_gaps(Samples& samples) {
  constexpr double kGap = 1.6;
  const std::vector<double> all = periods(samples);
  if (all.size() < 2) return {};
  const double usual = median(all);
  std::vector<std::size_t> gaps, still;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] > kGap * usual) gaps.push_back(i);
    if (all[i] <= 0.0) still.push_back(i);
  }
  std::vector<Finding> findings;
  if (!still.empty()) {
    findings.push_back({.where = between(samples, still.front()),
                        .what = "the time does not advance" + and_more(still.size()),
                        .remedy = "Give each scan its own time, or leave times.txt out."});
  }
  if (!gaps.empty() && usual > 0.0) {
    findings.push_back(
        {.where = between(samples, gaps.front()),
         .what = fmt::format("{} s pass, where {} s are usual{}", fixed_text(all[gaps.front()], 3),
                             fixed_text(usual, 3), and_more(gaps.size()))});
  }
  return findings;
}

/// Scans that were left out and renumbered show in the motion alone.
std::vector<Finding> look_for_jumps(Samples& samples) {
  constexpr double kJump = 1.7, kSlack = 0.3;
  if (!pose_verdict(samples).check.empty()) return {};
  const auto& poses = samples.poses();
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto& files = samples.files();
    const double time = files.empty() ? 1.0 : files[i].time_s - files[i - 1].time_s;
    const double first = files.empty() ? 1.0 : files[1].time_s - files[0].time_s;
    const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
    steps.push_back(time > 0.0 && first > 0.0 ? step / time * first : step);
  }
  std::vector<std::size_t> jumps;
  for (std::size_t i = 1; i + 1 < steps.size(); ++i) {
    if (steps[i] > kJump * std::max(steps[i - 1], steps[i + 1]) + kSlack) jumps.push_back(i);
  }
  if (jumps.empty()) return {};
  const std::size_t at = jumps.front();
  return {{.where = samples.pose_source() + ", " + between(samples, at),
           .what = fmt::format("the sensor moves {} m, but {} m and {} m before and after{}",
                               fixed_text(steps[at], 2), fixed_text(steps[at - 1], 2),
                               fixed_text(steps[at + 1], 2), and_more(jumps.size()))}};
}

/// What `pose_verdict` finds goes first: this is about poses that are nearly right.
std::vector<Finding> look_for_time_offset(Samples& samples) {
  if (!pose_verdict(samples).check.empty()) return {};
  const std::optional<TimeOffset> offset = find_time_offset(samples);
  if (!offset || !is_clear(*offset)) return {};
  return {{.what = time_offset_text(*offset),
           .remedy = "Say " + time_offset_option(samples, *offset) + "."}};
}

}  // namespace

std::vector<Check> time_checks() {
  return {
      {"time-offset", "scans and poses are of clocks that differ", "scans and poses on one clock",
       "Say --time-offset with the time of poses less that of "
       "scans.",
       look_for_time_offset},
      {"gap-in-time", "scans are missing in between", "one scan a period",
       "Add the missing scans, or choose frames without the gap (--frames).", look_for_gaps},
      {"jump-in-motion", "scans were left out and the rest renumbered, or a pose is wrong",
       "a speed that changes little from scan to scan",
       "Put the missing scans back, or repair the pose.", look_for_jumps},
  };
}

}  // namespace raymoval::inspection
