// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/error.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/ego/ego_estimate.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"

namespace raymoval::inspection {
namespace {

/// Steps with a larger ratio are not those of the sensor. 10 Hz and 15 Hz have this ratio.
constexpr double kMostRatio = 1.5;

bool differs(double named, double seen) {
  if (!(named > 0.0) || !(seen > 0.0)) return false;
  return std::max(named / seen, seen / named) > kMostRatio;
}

std::string degrees(double radians) {
  return fixed_text(radians / kDegree, 2) + " deg";
}

/// Share of the points more than `margin` radians above or below the field of view, about the spin
/// axis that the scans show.
double share_out_of_view(const Samples& samples, const SensorModel& sensor, double margin) {
  const Eigen::Matrix3d turn = turn_to_z(samples.estimated_sensor().spin_axis);
  std::size_t points = 0, out = 0;
  for (const auto& [index, scan] : samples.scans()) {
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = turn * point.cast<double>();
      const double elevation = std::atan2(p.z(), p.head<2>().norm());
      ++points;
      if (elevation < sensor.elevation_min - margin || elevation > sensor.elevation_max + margin) {
        ++out;
      }
    }
  }
  return points > 0 ? static_cast<double>(out) / static_cast<double>(points) : 0.0;
}

/// Finds a wrong sensor name. A narrower field of view is no evidence, because there may be no
/// objects; neither are steps if the scans show no beams, because they may be downsampled.
std::vector<Finding> look_for_other_sensor(Samples& samples) {
  constexpr double kMargin = 2.0 * kDegree, kShare = 0.02;
  const SensorModel& named = samples.sequence().scans->sensor();
  if (named.is_estimated() || !pose_verdict(samples).check.empty()) return {};
  const SensorModel& seen = samples.estimated_sensor();
  const double out = share_out_of_view(samples, named, kMargin);
  samples.measures.emplace_back("azimuth_step_deg", seen.azimuth_step / kDegree);
  samples.measures.emplace_back("elevation_step_deg", seen.elevation_step / kDegree);
  samples.measures.emplace_back("share_of_points_out_of_view", out);
  std::vector<std::string> what;
  if (seen.has_beams()) {
    if (differs(named.azimuth_step, seen.azimuth_step)) {
      what.push_back(fmt::format("its directions are {} apart in azimuth and those of the scans {}",
                                 degrees(named.azimuth_step), degrees(seen.azimuth_step)));
    }
    if (differs(named.elevation_step, seen.elevation_step)) {
      what.push_back("its beams are " + degrees(named.elevation_step) +
                     " apart and those of the scans " + degrees(seen.elevation_step));
    }
  }
  if (out > kShare) {
    what.push_back(fmt::format("it sees from {} to {} and {} % of the points lie beyond",
                               degrees(named.elevation_min), degrees(named.elevation_max),
                               fixed_text(100.0 * out, 1)));
  }
  if (what.empty()) return {};
  return {{.where = "sensor '" + named.name + "'", .what = join(what, "; ")}};
}

}  // namespace

std::string sensor_text(const Samples& samples) {
  const SensorModel& sensor = samples.sequence().scans->sensor();
  if (sensor.is_estimated()) return sensor.name + ": " + sensor.basis;
  return sensor.name + "; the scans show " + samples.estimated_sensor().basis;
}

std::vector<Check> sensor_model_checks() {
  return {{"other-sensor", "the scans are not from the named sensor",
           "steps and a field of view as the scans show them",
           "Name the right sensor (\"sensor\" in sequence.json, or --sensor), or let it be "
           "estimated (--sensor estimated).",
           look_for_other_sensor}};
}

namespace {

/// Share of a scan's points from which the ego vehicle is reported. Measured with points fixed to
/// the sensor of a simulated drive (16 beams, 22,000 points per scan): in peopleremover, points at
/// the sensor block every ray, and F1 falls from .749 to .720 with 10 points (0.045 %), to .124
/// with 20 (0.09 %), to .042 with 30. Next are dufomap (.196 to .186 with 30) and removert (.824 to
/// .810 with 1,000); octomap, raymoval, raymoval_plus and erasor stay within .005. The distance of
/// the points matters too: the cars of KITTI's drives (0.02 %) and of the scene town (0.06 %, where
/// labels make it a note) harm no method.
constexpr double kManyEgoPoints = 0.0005;

/// Evidence on the points that move along with the sensor.
struct EgoPoints {
  std::size_t all = 0, points = 0, labelled = 0;
  double farthest = 0.0;
  std::map<std::uint16_t, std::size_t> ids;
};

EgoPoints look_at_ego_points(const Samples& samples, const std::vector<std::size_t>& scans,
                             const EgoEstimate& estimate) {
  EgoPoints ego;
  const Sequence& sequence = samples.sequence();
  for (const std::size_t index : scans) {
    const Scan& scan = samples.scans().at(index);
    std::vector<std::uint32_t> words;
    try {
      if (sequence.labels) words = sequence.labels->labels(scan);
    } catch (const DataError&) {
      words.clear();  // Reported by the checks of labels.
    }
    ego.all += scan.size();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d p = scan.points[i].cast<double>();
      if (!estimate.contains(p)) continue;
      ++ego.points;
      ego.farthest = std::max(ego.farthest, p.norm());
      if (words.empty()) continue;
      ++ego.ids[semantic_id(words[i])];
      if (sequence.label_rule.classify(words[i]) != LabelClass::kStatic) ++ego.labelled;
    }
  }
  return ego;
}

std::string ego_ids_text(const EgoPoints& ego) {
  std::vector<std::string> ids;
  for (const auto& [id, count] : ego.ids) {
    if (10 * count >= ego.points) ids.push_back(std::to_string(id));
  }
  return join(ids);
}

Finding ego_finding(const EgoPoints& ego, std::size_t scans, const EgoRegion& region) {
  const double share = static_cast<double>(ego.points) / static_cast<double>(ego.all);
  Finding finding;
  finding.where = "points of all scans read";
  finding.what = "about " + grouped_text(ego.points / scans) + " points a scan (" +
                 fixed_text(100.0 * share, 2) + " %), up to " + fixed_text(ego.farthest, 1) +
                 " m away, move with the sensor: they are on the ego vehicle";
  finding.remedy = "Leave them out with --drop-ego auto, here the box " + ego_region_text(region) +
                   " (or \"drop_ego\" in sequence.json); --range only limits what is evaluated.";
  if (10 * ego.labelled >= 8 * ego.points) {
    finding.severity = Severity::kNote;
    finding.what += "; they are labelled as such (" + ego_ids_text(ego) + ")";
    finding.remedy =
        "Nothing, if methods should get these points. If not: l" + finding.remedy.substr(1);
  }
  return finding;
}

std::vector<Finding> look_for_ego(Samples& samples) {
  constexpr std::size_t kAll = SIZE_MAX;
  if (!pose_verdict(samples).check.empty()) return {};
  std::vector<std::size_t> read;
  for (const auto& [index, scan] : samples.scans()) read.push_back(index);
  const std::vector<std::size_t> apart = poses_apart(samples.poses(), read, kAll);
  std::vector<const Scan*> scans;
  for (const std::size_t index : apart) scans.push_back(&samples.scans().at(index));
  const EgoEstimate estimate = estimate_ego(
      scans, [&](std::size_t k) -> const std::vector<Surfel>& { return samples.surfels(apart[k]); },
      samples.sequence().up().direction);
  if (!estimate.has_enough_motion()) return {};
  samples.measures.emplace_back("steady_cells", static_cast<double>(estimate.steady));
  samples.measures.emplace_back("steady_cells_at_sensor", static_cast<double>(estimate.own.size()));
  if (!estimate.found()) return {};
  const EgoPoints ego = look_at_ego_points(samples, apart, estimate);
  const double share = static_cast<double>(ego.points) / static_cast<double>(ego.all);
  samples.measures.emplace_back("share_of_points_at_sensor", share);
  if (share < kManyEgoPoints) return {};
  return {ego_finding(ego, scans.size(), estimate.region())};
}

}  // namespace

std::vector<Check> ego_checks() {
  return {
      {"ego-vehicle", "the ego vehicle is in view",
       "no point on it, which methods treat as a static object",
       "Leave it out with --drop-ego auto, or give its region.", look_for_ego},
  };
}

}  // namespace raymoval::inspection
