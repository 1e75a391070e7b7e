// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "core/text.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pose_fit.h"
#include "datasets/registration/ray_origin.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kScans = 3, kFewestLines = 300;
constexpr double kNear = 0.3;  // metres: a smaller offset changes no result
/// Largest misfit of a found origin, and least gain over the misfit of the frame's origin. In
/// simulated scenes with 16 to 64 beams, the gain is at most 0.01 for right data, and 0.07 or more
/// for data in a frame 1.8 m away; two merged sensors have a misfit of 0.59. With 128 beams,
/// neighbours on a scan line are not found, and there is no finding.
constexpr double kFound = 0.56, kGain = 0.06;

/// Whether the lines show where the beams start.
bool is_known(const registration::RayOrigin& found) {
  return found.lines >= kFewestLines && found.misfit_found <= kFound;
}

/// Whether they show that this is not the origin of the points.
bool is_elsewhere(const registration::RayOrigin& found) {
  return is_known(found) && found.origin.norm() >= kNear &&
         found.misfit_given - found.misfit_found >= kGain;
}

std::string place_text(const Eigen::Vector3d& place) {
  return fixed_text(place.x(), 2) + "," + fixed_text(place.y(), 2) + "," + fixed_text(place.z(), 2);
}

/// A frame of tf whose origin is where the beams start, and that origin.
using NamedPlace = std::pair<std::string, Eigen::Vector3d>;

/// The nearest frame of tf within `kNear` of `place`.
std::optional<NamedPlace> frame_at(const Samples& samples, const Eigen::Vector3d& place) {
  if (!samples.sequence().fixed_frames) return std::nullopt;
  std::optional<NamedPlace> nearest;
  double least = kNear;
  for (const auto& [name, origin] : samples.sequence().fixed_frames()) {
    const double distance = (origin - place).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = {name, origin};
  }
  return nearest;
}

/// @param given the user's origin @param right the origin in the frame of the stored points
std::string remedy_of(const Samples& samples, const Eigen::Vector3d& given,
                      const Eigen::Vector3d& right) {
  if (right.norm() < kNear && !given.isZero()) return "Leave --sensor-origin out.";
  const auto frame = frame_at(samples, right);
  if (!frame) return "Use --sensor-origin " + place_text(right) + ".";
  return "Use --sensor-origin " + place_text(frame->second) + ", the origin of frame '" +
         frame->first + "' in tf.";
}

/// The field that names the sensor of a point; empty if there is none.
std::string sensor_field(const Samples& samples) {
  const std::optional<SensorPlaces>& given = samples.sequence().sensor_origin;
  if (!samples.sequence().topics.empty()) return kTopicField;
  if (given && !given->field.empty()) return given->field;
  const auto& records = samples.sequence().records;
  if (records == nullptr || samples.scans().empty()) return "";
  const RecordLayout layout = records->layout(samples.scans().begin()->first);
  const PointField* field = find_sensor_field(layout);
  return field == nullptr ? "" : field->name;
}

/// The points of each sensor of merged clouds, with their origin at `places` where it is given.
/// Empty if the points name no sensor, or only one.
std::map<std::int64_t, std::vector<Scan>> clouds_of_sensors(const Samples& samples,
                                                            const SensorPlaces& places) {
  constexpr std::size_t kMostSensors = 16;
  std::map<std::int64_t, std::vector<Scan>> clouds;
  if (const auto& topics = samples.sequence().topics; !topics.empty()) {
    for (const auto& [index, scan] : samples.scans()) {
      clouds[static_cast<std::int64_t>(topics[index])].push_back(scan);
    }
    return clouds;
  }
  if (places.field.empty()) return clouds;
  for (const Scan& whole : samples.some_scans(kScans)) {
    std::map<std::int64_t, Scan> of_sensor;
    const auto numbers = sensor_numbers(*samples.sequence().records, whole, places.field);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const auto place = places.by_number.find(numbers[i]);
      Eigen::Vector3f origin = Eigen::Vector3f::Zero();
      if (place != places.by_number.end()) origin = place->second.cast<float>();
      of_sensor[numbers[i]].points.push_back(whole.points[i] - origin);
    }
    for (auto& [number, scan] : of_sensor) clouds[number].push_back(std::move(scan));
    if (clouds.size() > kMostSensors) return {};
  }
  if (clouds.size() == 1) clouds.clear();
  return clouds;
}

SeenSensors look_at_sensors(const Samples& samples) {
  SensorPlaces places = samples.sequence().sensor_origin.value_or(SensorPlaces());
  const bool topics = !samples.sequence().topics.empty();
  const bool given = topics || !places.field.empty();
  places.field = sensor_field(samples);
  const auto clouds = clouds_of_sensors(samples, places);
  if (clouds.empty()) return {};
  SeenSensors seen{true};
  std::vector<std::string> parts;
  bool wrong = false;
  for (const auto& [number, scans] : clouds) {
    const registration::RayOrigin found = registration::find_ray_origin(scans);
    const bool known = given || is_known(found);
    if (is_elsewhere(found)) places.by_number[number] += found.origin;
    wrong = wrong || is_elsewhere(found) || !known;
    seen.are_known = seen.are_known && known;
    parts.push_back(std::to_string(number) + "=" +
                    (known ? place_text(places.by_number[number]) : "X,Y,Z"));
  }
  if (!wrong) return seen;
  Finding finding;
  finding.where = samples.all_frames();
  finding.what = topics ? "scan lines show that beams do not start at the origin of their topic's "
                          "points"
                        : fmt::format("field '{}' names {} sensors whose clouds are merged",
                                      places.field, clouds.size());
  finding.remedy = "Use --sensor-origin " + places.field + ":" + join(parts, "/") + ".";
  if (!seen.are_known) {
    finding.remedy += " X,Y,Z is the position of a sensor in the frame of the points.";
  }
  seen.findings = {finding};
  return seen;
}

const SeenSensors& seen_sensors(Samples& samples) {
  if (!samples.seen_sensors) samples.seen_sensors = look_at_sensors(samples);
  return *samples.seen_sensors;
}

std::vector<Finding> look_for_ray_origin(Samples& samples) {
  if (samples.point_scale() != 1.0 || !pose_verdict(samples).check.empty()) return {};
  const std::vector<Scan> chosen = samples.some_scans(kScans);
  if (chosen.size() < kScans) return {};
  if (const SeenSensors& seen = seen_sensors(samples); seen.are_merged) {
    return seen.are_known ? seen.findings : std::vector<Finding>();
  }
  const registration::RayOrigin found = registration::find_ray_origin(chosen);
  const Eigen::Vector3d& at = found.origin;
  samples.measures.emplace_back("ray_lines", static_cast<double>(found.lines));
  samples.measures.emplace_back("ray_misfit_of_frame", found.misfit_given);
  samples.measures.emplace_back("ray_misfit_found", found.misfit_found);
  samples.measures.emplace_back("ray_origin_x", at.x());
  samples.measures.emplace_back("ray_origin_y", at.y());
  samples.measures.emplace_back("ray_origin_z", at.z());
  if (!is_elsewhere(found)) return {};
  const Eigen::Vector3d given = samples.sequence().sensor_origin.value_or(SensorPlaces()).one;
  return {{.where = samples.all_frames(),
           .what = "scan lines show that the beams start at (" + place_text(at) +
                   ") m and not at the origin of the points' frame",
           .remedy = remedy_of(samples, given, given + at)}};
}

std::vector<Finding> look_for_merged(Samples& samples) {
  constexpr std::size_t kMergedScans = 6;
  if (samples.point_scale() != 1.0 || !pose_verdict(samples).check.empty()) return {};
  if (const SeenSensors& seen = seen_sensors(samples); seen.are_merged) {
    return seen.are_known ? std::vector<Finding>() : seen.findings;
  }
  const std::vector<Scan> chosen = samples.some_scans(kMergedScans);
  if (chosen.size() < kMergedScans) return {};
  const auto origins = registration::find_merged_origins(chosen);
  if (!origins) return {};
  return {{.where = samples.all_frames(),
           .what = "scan lines show two sensors whose clouds are merged, at (" +
                   place_text((*origins)[0]) + ") and (" + place_text((*origins)[1]) + ") m"}};
}

}  // namespace

std::vector<Check> origin_checks() {
  return {{"beams-start-elsewhere", "points are in the frame of a vehicle, not of the sensor",
           "points whose origin is the sensor, where the beams start",
           "Use --sensor-origin with the position of the sensor in the frame of the points.",
           look_for_ray_origin, Consequence::kRefused},
          {"merged-sensors", "clouds of two sensors are merged, so rays start at the wrong place",
           "a cloud for each sensor, or a field 'lidar_id' that names the sensor of each point",
           "Write the clouds before they are merged, or with such a field.", look_for_merged,
           Consequence::kWarned}};
}

}  // namespace raymoval::inspection
