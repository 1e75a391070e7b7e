// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/world_file.h"

#include <cmath>
#include <filesystem>

#include "core/angle.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/simulation/shapes/bodies.h"

namespace raymoval::simulated {
namespace {

/// Metres from the origin along x or y, either way, within which all of a world lies.
constexpr double kWorldReach = 1e5;

/// Errors of paths and speed profiles, with the place in the file put before them.
template <class Make>
auto at_place(const std::string& where, Make make) {
  try {
    return make();
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(where + ": " + error.what());
  }
}

Terrain read_terrain(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, "hills_m wavelength_m margin_m roughness_m grid_m cover");
  Terrain t;
  t.hills_m = f.number("hills_m", t.hills_m, 0.0, 30.0);
  t.wavelength_m = f.number("wavelength_m", t.wavelength_m, 20.0, 5000.0);
  t.margin_m = f.number("margin_m", t.margin_m, 10.0, 300.0);
  t.roughness_m = f.number("roughness_m", t.roughness_m, 0.0, 1.0);
  t.grid_m = f.number("grid_m", t.grid_m, 0.25, 16.0);
  const std::string cover = f.choice("cover", "grass", {"grass", "paved", "soil"});
  t.paved = cover == "paved";
  t.soil = cover == "soil";
  return t;
}

Road read_road(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 "name points closed width_m crown_m kerb_m sidewalk_m verge_m surface");
  Road road;
  road.name = f.text("name", "road");
  static_cast<void>(f.member("points"));
  const auto points = f.points("points", kWorldReach);
  const bool closed = f.flag("closed", false);
  road.path = at_place(f.place("points"), [&] { return Path(points, closed); });
  road.width_m = f.number("width_m", road.width_m, 1.0, 60.0);
  road.crown_m = f.number("crown_m", road.crown_m, 0.0, 1.0);
  road.kerb_m = f.number("kerb_m", road.kerb_m, 0.0, 0.5);
  road.sidewalk_m = f.number("sidewalk_m", road.sidewalk_m, 0.0, 20.0);
  road.verge_m = f.number("verge_m", road.verge_m, 0.5, 20.0);
  road.gravel = f.choice("surface", "asphalt", {"asphalt", "gravel"}) == "gravel";
  return road;
}

SpeedProfile read_speed(const Fields& f, const std::string& key) {
  if (!f.has(key)) return {};
  if (f.is_number(key)) return SpeedProfile({{0.0, f.number(key, 0.0, 0.0, 100.0)}});
  for (const auto& [time, speed] : f.pairs(key)) {
    if (std::abs(time) > 1e6 || std::abs(speed) > 100.0) {
      f.fail(key, "pairs of seconds and metres a second, [0, 8], at most 1e6 and 100");
    }
  }
  return at_place(f.place(key), [&] { return SpeedProfile(f.pairs(key)); });
}

const std::string kRouteKeys = "road lane_m reverse points start_m ";

Route read_route(const Fields& f, const std::string& speed_key) {
  Route route;
  route.road = f.text("road", "");
  route.lane_m = f.number("lane_m", 0.0, -200.0, 200.0);
  route.reverse = f.flag("reverse", false);
  route.points = f.points("points", kWorldReach);
  route.start_m = f.number("start_m", 0.0, -1e5, 1e5);
  if (!speed_key.empty()) route.speed = read_speed(f, speed_key);
  if (route.road.empty() == route.points.empty()) {
    f.fail("road", "either 'road' or 'points', not both or none");
  }
  if (!route.points.empty()) at_place(f.place("points"), [&] { return Path(route.points, false); });
  return route;
}

PartSpec read_part(const Fields& f) {
  PartSpec part;
  static_cast<void>(f.member("part"));
  part.part = f.choice("part", "", part_names());
  part.length_m = f.number("length_m", 0.0, 0.0, 500.0);
  part.width_m = f.number("width_m", 0.0, 0.0, 500.0);
  part.height_m = f.number("height_m", 0.0, 0.0, 200.0);
  return part;
}

RowSpec read_row(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 "road side from_m to_m offset_m spacing_m share turn_deg part length_m "
                 "width_m height_m");
  RowSpec row;
  row.road = f.text("road", "");
  const std::string side = f.choice("side", "both", {"left", "right", "both"});
  row.left = side != "right";
  row.right = side != "left";
  row.from_m = f.number("from_m", 0.0, 0.0, 1e5);
  row.to_m = f.number("to_m", -1.0, -1.0, 1e5);
  row.offset_m = f.interval("offset_m", {6.0, 6.0}, -1000.0, 1000.0);
  row.spacing_m = f.interval("spacing_m", {10.0, 10.0}, 0.5, 500.0);
  row.share = f.number("share", 1.0, 0.0, 1.0);
  row.turn_rad = f.number("turn_deg", 0.0, -360.0, 360.0) * kDegree;
  row.part = read_part(f);
  return row;
}

PlaceSpec read_place(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, "part at yaw_deg length_m width_m height_m");
  PlaceSpec place;
  const std::vector<double> at = f.numbers("at");
  if (at.size() != 2 || std::abs(at[0]) > kWorldReach || std::abs(at[1]) > kWorldReach) {
    f.fail("at", "[x, y] in metres, at most " + number_text(kWorldReach) + " from the origin");
  }
  place.at = {at[0], at[1]};
  place.yaw_rad = f.number("yaw_deg", 0.0, -360.0, 360.0) * kDegree;
  place.part = read_part(f);
  return place;
}

MoverSpec read_mover(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, kRouteKeys + "kind speed group");
  MoverSpec mover;
  mover.kind = f.choice("kind", "car", body_kinds());
  mover.group = f.integer("group", 1, 1, 20);
  mover.route = read_route(f, "speed");
  return mover;
}

FlowSpec read_flow(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, kRouteKeys + "kinds speed_mps gap_m group from_m to_m");
  FlowSpec flow;
  flow.route = read_route(f, "");
  flow.speed_mps = f.interval("speed_mps", {8.0, 8.0}, 0.0, 100.0);
  flow.gap_m = f.interval("gap_m", {20.0, 60.0}, 1.0, kWorldReach);
  flow.group = f.integer("group", 1, 1, 20);
  if (f.has("from_m")) flow.from_m = f.number("from_m", 0.0, -1e5, 1e5);
  flow.to_m = f.number("to_m", -1.0, -1.0, 1e5);
  const Fields weights(f.member("kinds"), f.place("kinds"), join(body_kinds(), " "));
  for (const std::string& kind : weights.names()) {
    flow.kinds.emplace_back(kind, weights.number(kind, 1.0, 0.0, 1e6));
  }
  if (flow.kinds.empty()) f.fail("kinds", "at least one kind with its weight");
  return flow;
}

EgoSpec read_ego(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 kRouteKeys +
                     "speed body sensor_height_m sensor_forward_m sensor_left_m sensor_pitch_deg "
                     "vibration_m vibration_deg dig_period_s");
  EgoSpec ego;
  ego.route = read_route(f, "speed");
  ego.body = f.choice("body", "car", {"car", "excavator", "none"});
  ego.sensor_height_m = f.number("sensor_height_m", ego.sensor_height_m, 0.05, 50.0);
  ego.sensor_forward_m = f.number("sensor_forward_m", 0.0, -20.0, 20.0);
  ego.sensor_left_m = f.number("sensor_left_m", 0.0, -20.0, 20.0);
  ego.sensor_pitch_rad = f.number("sensor_pitch_deg", 0.0, -90.0, 90.0) * kDegree;
  ego.vibration_m = f.number("vibration_m", 0.0, 0.0, 0.5);
  ego.vibration_rad = f.number("vibration_deg", 0.0, 0.0, 10.0) * kDegree;
  ego.dig_period_s = f.number("dig_period_s", ego.dig_period_s, 2.0, 1000.0);
  return ego;
}

}  // namespace

WorldFile world_from_json(const nlohmann::json& json, const std::string& file) {
  const Fields f(json, file,
                 "description sensor scans range_m seed terrain roads rows places "
                 "movers flows ego");
  WorldFile world;
  world.name = std::filesystem::path(file).stem().string();
  world.description = f.text("description", "");
  world.sensor = f.text("sensor", "hdl64e");
  world.scans = f.integer("scans", world.scans, 1, 100000);
  world.range_m = f.interval("range_m", world.range_m, 0.0, 1e4);
  world.seed = static_cast<std::uint64_t>(f.integer("seed", 1, 0, 1000000000));
  if (f.has("terrain")) world.terrain = read_terrain(f.member("terrain"), f.place("terrain"));
  for (const auto& [item, where] : f.list("roads")) world.roads.push_back(read_road(*item, where));
  for (const auto& [item, where] : f.list("rows")) world.rows.push_back(read_row(*item, where));
  for (const auto& [item, where] : f.list("places")) {
    world.places.push_back(read_place(*item, where));
  }
  for (const auto& [item, where] : f.list("movers")) {
    world.movers.push_back(read_mover(*item, where));
  }
  for (const auto& [item, where] : f.list("flows")) world.flows.push_back(read_flow(*item, where));
  world.ego = read_ego(f.member("ego"), f.place("ego"));
  if (world.roads.empty()) f.fail("roads", "at least one road");
  double length = 0.0;
  for (const Road& road : world.roads) length += road.path.length();
  if (length > 2.0 * kWorldReach) f.fail("roads", "at most 200 km together");
  return world;
}

}  // namespace raymoval::simulated
