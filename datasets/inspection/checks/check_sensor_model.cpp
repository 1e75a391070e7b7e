// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"

namespace raymoval::inspection {
namespace {

/// Steps that differ by more are not those of the sensor; 10 Hz and 15 Hz differ by as much.
constexpr double kMostRatio = 1.5;

bool differs(double named, double seen) {
  if (!(named > 0.0) || !(seen > 0.0)) return false;
  return std::max(named / seen, seen / named) > kMostRatio;
}

std::string degrees(double radians) {
  return fixed_text(radians / kDegree, 2) + " deg";
}

/// Share of the points more than `margin` radians above or below the field of view.
double share_out_of_view(const Samples& samples, const SensorModel& sensor, double margin) {
  std::size_t points = 0, out = 0;
  for (const auto& [index, scan] : samples.scans()) {
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = point.cast<double>();
      const double elevation = std::atan2(p.z(), p.head<2>().norm());
      ++points;
      if (elevation < sensor.elevation_min - margin || elevation > sensor.elevation_max + margin) {
        ++out;
      }
    }
  }
  return points > 0 ? static_cast<double>(out) / static_cast<double>(points) : 0.0;
}

/// A sensor that is named by mistake. A narrower field of view says nothing, for nothing may stand
/// there; neither do steps where the scans show no beams, for they may be thinned out.
std::vector<Finding> look_for_other_sensor(Samples& samples) {
  constexpr double kMargin = 2.0 * kDegree, kShare = 0.02;
  const SensorModel& named = samples.sequence().scans->sensor();
  if (named.is_estimated() || !pose_verdict(samples).check.empty()) return {};
  const SensorModel& seen = samples.seen_sensor();
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
  return sensor.name + "; the scans show " + samples.seen_sensor().basis;
}

std::vector<Check> sensor_model_checks() {
  return {{"other-sensor", "the scans are not those of the sensor that is named",
           "steps and a field of view as the scans show them",
           "Name the right sensor (\"sensor\" in sequence.json, or --sensor), or let it be "
           "estimated (--sensor estimated).",
           look_for_other_sensor}};
}

}  // namespace raymoval::inspection
