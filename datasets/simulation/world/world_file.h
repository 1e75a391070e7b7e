// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/fields.h"
#include "datasets/simulation/shapes/parts.h"
#include "datasets/simulation/world/ego.h"
#include "datasets/simulation/world/ground.h"
#include "datasets/simulation/world/mover.h"
#include "datasets/simulation/world/path.h"

namespace raymoval::simulated {

/// One mover, or a few that walk together.
struct MoverSpec {
  std::string kind;
  Route route;
  int group = 1;
  Presence presence;
};

/// Many movers one after another in a lane.
struct FlowSpec {
  Route route;  ///< Its speed is set by `speed_mps`.
  NumberRange speed_mps;
  NumberRange gap_m;                                  ///< Between successive movers.
  std::vector<std::pair<std::string, double>> kinds;  ///< With weights.
  int group = 1;                                      ///< Largest group size.
  /// People and cyclists pause: interval and length of pauses. 0 = never.
  NumberRange stop_every_s, stop_for_s;
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
  NumberRange offset_m;              ///< From the middle of the road.
  NumberRange spacing_m;
  double share = 1.0;  ///< Of occupied places.
  double turn_rad = 0.0;
  Presence presence;  ///< Of parked vehicles only; other objects are always there.
  PartSpec part;
};

/// One part at a place.
struct PlaceSpec {
  Eigen::Vector2d at;
  double yaw_rad = 0.0;
  PartSpec part;
};

/// A world file. Angles in the file are degrees (keys end in _deg).
struct WorldFile {
  std::string name;
  std::string description;
  std::string sensor;
  int scans = 100;
  NumberRange range_m{2.7, 80.0};
  std::uint64_t seed = 1;  ///< Of the static world; movers and noise use the caller's seed.
  Terrain terrain;
  std::vector<Road> roads;
  std::vector<RowSpec> rows;
  std::vector<PlaceSpec> places;
  std::vector<MoverSpec> movers;
  std::vector<FlowSpec> flows;
  std::vector<QueueSpec> queues;
  Air air;
  EgoSpec ego;
};

/// @param file its path for messages; the stem is the name of the world
/// @throws ConfigurationError naming the place in the file, what is wrong and what was expected.
WorldFile world_from_json(const nlohmann::json& json, const std::string& file);

}  // namespace raymoval::simulated
