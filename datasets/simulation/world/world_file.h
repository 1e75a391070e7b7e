// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/simulation/shapes/fields.h"
#include "datasets/simulation/shapes/path.h"
#include "datasets/simulation/world/ground.h"
#include "datasets/simulation/world/world_parts.h"

namespace raymoval::simulated {

/// Where something goes and how fast: along a road, or along points of its own.
struct Route {
  std::string road;                     ///< Empty = `points`.
  double lane_m = 0.0;                  ///< To the left of the road's middle, seen along the road.
  bool reverse = false;                 ///< Against the direction of the road.
  std::vector<Eigen::Vector2d> points;  ///< In the plane of the world, metres.
  double start_m = 0.0;                 ///< Distance along the route at time 0.
  SpeedProfile speed;
};

/// One mover, or a few that walk together.
struct MoverSpec {
  std::string kind;
  Route route;
  int group = 1;
};

/// Many movers one after another in a lane.
struct FlowSpec {
  Route route;  ///< Its speed is set by `speed_mps`.
  Interval speed_mps;
  Interval gap_m;                                     ///< Between one and the next.
  std::vector<std::pair<std::string, double>> kinds;  ///< With weights.
  int group = 1;                                      ///< At most so many together.
  /// Start positions at time 0. Without `from_m` an open route is fed from its beginning for as
  /// long as the sequence lasts; without `to_m` (-1) it is filled to its end.
  std::optional<double> from_m;
  double to_m = -1.0;
};

/// Parts along a road, at equal or random distances.
struct RowSpec {
  std::string road;
  bool left = true, right = true;
  double from_m = 0.0, to_m = -1.0;  ///< -1 = the end.
  Interval offset_m;                 ///< From the middle of the road.
  Interval spacing_m;
  double share = 1.0;  ///< Of the places that are taken.
  double turn_rad = 0.0;
  PartSpec part;
};

/// One part at a place.
struct PlaceSpec {
  Eigen::Vector2d at;
  double yaw_rad = 0.0;
  PartSpec part;
};

/// What carries the sensor.
struct EgoSpec {
  Route route;
  std::string body = "car";  ///< car, excavator or none.
  double sensor_height_m = 1.73;
  double sensor_forward_m = 0.0;
  double sensor_left_m = 0.0;
  double sensor_pitch_rad = 0.0;  ///< Positive = looking down.
  double vibration_m = 0.0;
  double vibration_rad = 0.0;
  double dig_period_s = 18.0;  ///< Of an excavator: one dig, swing, dump, swing back.
};

/// A world as its file says it. Angles in the file are degrees (keys end in _deg).
struct WorldFile {
  std::string name;
  std::string description;
  std::string sensor;
  int scans = 100;
  Interval range_m{2.7, 80.0};
  std::uint64_t seed = 1;  ///< Of the standing world; movers and noise take the caller's.
  Terrain terrain;
  std::vector<Road> roads;
  std::vector<RowSpec> rows;
  std::vector<PlaceSpec> places;
  std::vector<MoverSpec> movers;
  std::vector<FlowSpec> flows;
  EgoSpec ego;
};

/// @param file its path for messages; the stem is the name of the world
/// @throws ConfigurationError naming the place in the file, what is wrong and what was expected.
WorldFile world_from_json(const nlohmann::json& json, const std::string& file);

}  // namespace raymoval::simulated
