// SPDX-License-Identifier: MIT
#include "datasets/simulation/sensor/sensor_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/angle.h"
#include "core/error.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
/// Largest number of shots of a sweep, which bounds memory; no sensor has more.
constexpr double kMostShots = 1e7;

std::vector<double> read_beams(const Fields& f) {
  std::vector<double> beams = f.numbers("elevations_deg");
  for (const double beam : beams) {
    if (std::abs(beam) > 90.0) f.fail("elevations_deg", "numbers from -90 to 90");
  }
  for (const auto& [item, where] : f.list("banks")) {
    const Fields bank(*item, where, "from_deg to_deg count");
    const int count = bank.integer("count", 0, 2, 1024);
    const double from = bank.number("from_deg", 0.0, -90.0, 90.0);
    const double to = bank.number("to_deg", 0.0, -90.0, 90.0);
    for (int i = 0; i < count; ++i) beams.push_back(from + (to - from) * i / (count - 1));
  }
  if (beams.empty()) f.fail("banks", "'banks' or 'elevations_deg' with at least one beam");
  // The lasers of a real head are not mounted at exact steps. The jitter is always the same.
  const double jitter = f.number("elevation_jitter_deg", 0.0, 0.0, 1.0);
  Random random(1, Purpose::kSensor);
  for (double& beam : beams) beam = (beam + jitter * random.normal()) * kDegree;
  return beams;
}

void read_pattern(const Fields& f, SensorFile& sensor) {
  using Kind = SensorFile::Kind;
  const std::string kind = f.choice("kind", "spinning", {"spinning", "raster", "rosette"});
  sensor.kind =
      kind == "spinning" ? Kind::kSpinning : (kind == "raster" ? Kind::kRaster : Kind::kRosette);
  if (sensor.kind == Kind::kSpinning) {
    sensor.elevations = read_beams(f);
    sensor.azimuth_step = f.number("azimuth_step_deg", 0.2, 0.01, 10.0) * kDegree;
  } else if (sensor.kind == Kind::kRaster) {
    const NumberRange azimuth = f.interval("azimuth_deg", {-60.0, 60.0}, -360.0, 360.0);
    const NumberRange elevation = f.interval("elevation_deg", {-17.5, 17.5}, -90.0, 90.0);
    sensor.azimuth = {azimuth.low * kDegree, azimuth.high * kDegree};
    sensor.elevation = {elevation.low * kDegree, elevation.high * kDegree};
    sensor.columns = f.integer("columns", 600, 2, 10000);
    sensor.rows = f.integer("rows", 120, 2, 10000);
  } else {
    sensor.points = f.integer("points", 24000, 1, 10000000);
    sensor.half_angle = f.number("half_angle_deg", 35.0, 0.1, 89.0) * kDegree;
    const std::vector<double> prisms = f.numbers("prism_hz");
    if (prisms.size() != 2 || std::abs(prisms[0]) > 1e6 || std::abs(prisms[1]) > 1e6) {
      f.fail("prism_hz", "two speeds, the second negative if against");
    }
    sensor.prism_hz = {prisms[0], prisms[1]};
  }
}

/// @throws ConfigurationError if a sweep has more than `kMostShots`
void check_size(const Fields& f, const SensorFile& s) {
  if (s.kind == SensorFile::Kind::kSpinning &&
      static_cast<double>(s.elevations.size()) * 2.0 * kPi / s.azimuth_step > kMostShots) {
    f.fail("azimuth_step_deg", "a step that gives at most 10,000,000 shots a sweep");
  }
  if (static_cast<double>(s.rows) * s.columns > kMostShots) {
    f.fail("columns", "at most 10,000,000 shots a sweep (columns x rows)");
  }
}

std::vector<Shot> spinning_shots(const SensorFile& s, std::size_t scan, std::uint64_t seed) {
  const int columns = static_cast<int>(std::lround(2.0 * kPi / s.azimuth_step));
  const double phase = Random(seed, Purpose::kPhase, scan).unit();
  std::vector<Vector3d> headings;
  std::vector<double> times;
  for (int c = 0; c < columns; ++c) {
    const double azimuth = 2.0 * kPi * (c + phase) / columns;
    headings.emplace_back(std::cos(azimuth), std::sin(azimuth), 0.0);
    // The head turns clockwise and faces ahead at the reference time.
    const double signed_turn = azimuth > kPi ? azimuth - 2.0 * kPi : azimuth;
    times.push_back(-s.period_s * signed_turn / (2.0 * kPi));
  }
  std::vector<Shot> shots;
  shots.reserve(s.elevations.size() * headings.size());
  for (const double elevation : s.elevations) {
    const double level = std::cos(elevation);
    const double up = std::sin(elevation);
    for (std::size_t c = 0; c < headings.size(); ++c) {
      shots.push_back({Vector3d(level * headings[c].x(), level * headings[c].y(), up), times[c]});
    }
  }
  return shots;
}

std::vector<Shot> raster_shots(const SensorFile& s) {
  std::vector<Shot> shots;
  shots.reserve(static_cast<std::size_t>(s.rows) * static_cast<std::size_t>(s.columns));
  for (int r = 0; r < s.rows; ++r) {
    const double elevation =
        s.elevation.high + (s.elevation.low - s.elevation.high) * r / (s.rows - 1);
    for (int c = 0; c < s.columns; ++c) {
      const double share = static_cast<double>(c) / (s.columns - 1);
      const double azimuth = s.azimuth.low + (s.azimuth.high - s.azimuth.low) * share;
      const double done = (r + share) / s.rows;
      shots.push_back({Vector3d(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation)),
                       s.period_s * (done - 0.5)});
    }
  }
  return shots;
}

std::vector<Shot> rosette_shots(const SensorFile& s, std::size_t scan) {
  std::vector<Shot> shots;
  shots.reserve(static_cast<std::size_t>(s.points));
  for (int i = 0; i < s.points; ++i) {
    const double share = (i + 0.5) / s.points;
    const double time = (static_cast<double>(scan) + share) * s.period_s;
    const auto prism = [&](double hz) {
      const double turns = hz * time;
      return 2.0 * kPi * (turns - std::floor(turns));
    };
    const double a = prism(s.prism_hz.first);
    const double b = prism(s.prism_hz.second);
    const double left = 0.5 * s.half_angle * (std::cos(a) + std::cos(b));
    const double up = 0.5 * s.half_angle * (std::sin(a) + std::sin(b));
    const double off = std::hypot(left, up);
    const double bend = off > 1e-12 ? std::sin(off) / off : 1.0;
    shots.push_back({Vector3d(std::cos(off), bend * left, bend * up), s.period_s * (share - 0.5)});
  }
  return shots;
}

}  // namespace

std::vector<Shot> SensorFile::shots(std::size_t scan, std::uint64_t seed) const {
  switch (kind) {
    case Kind::kSpinning:
      return spinning_shots(*this, scan, seed);
    case Kind::kRaster:
      return raster_shots(*this);
    case Kind::kRosette:
      return rosette_shots(*this, scan);
  }
  throw InternalError("unknown kind of sensor");
}

SensorModel SensorFile::model() const {
  SensorModel model;
  model.name = name;
  model.range_min = range_m.low;
  model.range_max = range_m.high;
  if (kind == Kind::kSpinning) {
    const auto [low, high] = std::minmax_element(elevations.begin(), elevations.end());
    model.elevation_min = *low;
    model.elevation_max = *high;
    model.azimuth_step = azimuth_step;
    model.elevation_step =
        (*high - *low) / std::max(1.0, static_cast<double>(elevations.size()) - 1.0);
  } else if (kind == Kind::kRaster) {
    model.azimuth_min = azimuth.low;
    model.azimuth_max = azimuth.high;
    model.elevation_min = elevation.low;
    model.elevation_max = elevation.high;
    model.azimuth_step = (azimuth.high - azimuth.low) / (columns - 1);
    model.elevation_step = (elevation.high - elevation.low) / (rows - 1);
  } else {
    model.azimuth_min = model.elevation_min = -half_angle;
    model.azimuth_max = model.elevation_max = half_angle;
    // Mean distance between neighbours if the shots were spread evenly over the cone.
    model.azimuth_step = model.elevation_step = half_angle * std::sqrt(kPi / points);
  }
  return model;
}

SensorFile sensor_from_json(const nlohmann::json& json, const std::string& file) {
  const Fields f(json, file,
                 "description kind banks elevations_deg elevation_jitter_deg "
                 "azimuth_step_deg azimuth_deg elevation_deg columns rows points "
                 "half_angle_deg prism_hz period_s range_m noise_m direction_noise_deg "
                 "divergence_mrad pulse_m dropout range_at_10_percent_m");
  SensorFile sensor;
  sensor.name = std::filesystem::path(file).stem().string();
  sensor.description = f.text("description", "");
  read_pattern(f, sensor);
  check_size(f, sensor);
  sensor.period_s = f.number("period_s", sensor.period_s, 1e-3, 100.0);
  sensor.range_m = f.interval("range_m", sensor.range_m);
  if (sensor.range_m.low < 0.0 || sensor.range_m.high <= sensor.range_m.low) {
    f.fail("range_m", "[nearest, farthest], both in metres and not negative");
  }
  sensor.noise_m = f.number("noise_m", sensor.noise_m, 0.0, 1.0);
  sensor.direction_noise = f.number("direction_noise_deg", 0.0, 0.0, 1.0) * kDegree;
  sensor.divergence = f.number("divergence_mrad", 0.0, 0.0, 50.0) * 1e-3;
  sensor.pulse_m = f.number("pulse_m", sensor.pulse_m, 0.0, 10.0);
  sensor.dropout = f.number("dropout", 0.0, 0.0, 1.0);
  sensor.range_at_10_percent_m =
      f.number("range_at_10_percent_m", sensor.range_at_10_percent_m, 1.0, 1e6);
  return sensor;
}

}  // namespace raymoval::simulated
