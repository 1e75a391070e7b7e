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

/// Largest distance of a world's objects from the origin along x or y, metres.
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
  const Fields f(json, where, "hills_m wavelength_m margin_m roughness_m grid_m cover slope");
  Terrain t;
  t.hills_m = f.number("hills_m", t.hills_m, 0.0, 30.0);
  t.wavelength_m = f.number("wavelength_m", t.wavelength_m, 20.0, 5000.0);
  t.margin_m = f.number("margin_m", t.margin_m, 10.0, 300.0);
  t.roughness_m = f.number("roughness_m", t.roughness_m, 0.0, 1.0);
  t.grid_m = f.number("grid_m", t.grid_m, 0.25, 16.0);
  if (f.has("slope")) {
    const std::vector<double> slope = f.numbers("slope");
    if (slope.size() != 2 || std::hypot(slope[0], slope[1]) > 0.7) {
      f.fail("slope", "[along x, along y] in metres a metre, at most 0.7 together");
    }
    t.slope = {slope[0], slope[1]};
  }
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

/// Speed over time, or height over distance; `pairs` names them in messages.
SpeedProfile read_profile(const Fields& f, const std::string& key,
                          const std::string& pairs = "seconds and metres a second") {
  if (!f.has(key)) return {};
  if (f.is_number(key)) return SpeedProfile({{0.0, f.number(key, 0.0, 0.0, 100.0)}});
  for (const auto& [time, speed] : f.pairs(key)) {
    if (std::abs(time) > 1e6 || std::abs(speed) > 100.0) {
      f.fail(key, "pairs of " + pairs + ", [0, 8], at most 1e6 and 100");
    }
  }
  return at_place(f.place(key), [&] { return SpeedProfile(f.pairs(key)); });
}

const std::string kRouteKeys = "road lane_m reverse points start_m lift ";

Route read_route(const Fields& f, const std::string& speed_key) {
  Route route;
  route.road = f.text("road", "");
  route.lane_m = f.number("lane_m", 0.0, -200.0, 200.0);
  route.reverse = f.flag("reverse", false);
  route.points = f.points("points", kWorldReach);
  route.start_m = f.number("start_m", 0.0, -1e5, 1e5);
  if (!speed_key.empty()) route.speed = read_profile(f, speed_key);
  route.lift = read_profile(f, "lift", "metres along the route and metres above the ground");
  if (route.road.empty() == route.points.empty()) {
    f.fail("road", "either 'road' or 'points', not both or none");
  }
  if (!route.points.empty()) at_place(f.place("points"), [&] { return Path(route.points, false); });
  return route;
}

const std::string kPresenceKeys = "present_from_s present_until_s ";

Presence read_presence(const Fields& f) {
  Presence presence;
  presence.from_s = f.number("present_from_s", presence.from_s);
  presence.until_s = f.number("present_until_s", presence.until_s);
  if (!(presence.from_s < presence.until_s)) {
    f.fail("present_until_s", "a time after 'present_from_s'");
  }
  return presence;
}

std::vector<std::pair<std::string, double>> read_kinds(const Fields& f) {
  const Fields weights(f.member("kinds"), f.place("kinds"), join(body_kinds(), " "));
  std::vector<std::pair<std::string, double>> kinds;
  for (const std::string& kind : weights.names()) {
    kinds.emplace_back(kind, weights.number(kind, 1.0, 0.0, 1e6));
  }
  if (kinds.empty()) f.fail("kinds", "at least one kind with its weight");
  return kinds;
}

PartSpec read_part(const Fields& f) {
  PartSpec part;
  static_cast<void>(f.member("part"));
  part.part = f.choice("part", "", part_names());
  part.length_m = f.number("length_m", 0.0, 0.0, 500.0);
  part.width_m = f.number("width_m", 0.0, 0.0, 500.0);
  part.height_m = f.number("height_m", 0.0, 0.0, 200.0);
  part.above_m = f.number("above_m", 0.0, 0.0, 200.0);
  return part;
}

RowSpec read_row(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 kPresenceKeys +
                     "road side from_m to_m offset_m spacing_m share turn_deg part length_m "
                     "width_m height_m above_m");
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
  row.presence = read_presence(f);
  if (row.presence.is_limited() && !row.part.part.starts_with("parked")) {
    f.fail("present_from_s", "a parked part; other parts are always present");
  }
  return row;
}

PlaceSpec read_place(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, "part at yaw_deg length_m width_m height_m above_m");
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
  const Fields f(json, where, kRouteKeys + kPresenceKeys + "kind speed group");
  MoverSpec mover;
  mover.kind = f.choice("kind", "car", body_kinds());
  mover.group = f.integer("group", 1, 1, 20);
  mover.route = read_route(f, "speed");
  mover.presence = read_presence(f);
  return mover;
}

FlowSpec read_flow(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 kRouteKeys + "kinds speed_mps gap_m group from_m to_m stop_every_s stop_for_s");
  FlowSpec flow;
  flow.route = read_route(f, "");
  flow.speed_mps = f.interval("speed_mps", {8.0, 8.0}, 0.0, 100.0);
  flow.gap_m = f.interval("gap_m", {20.0, 60.0}, 0.3, kWorldReach);
  flow.group = f.integer("group", 1, 1, 20);
  if (f.has("from_m")) flow.from_m = f.number("from_m", 0.0, -1e5, 1e5);
  flow.to_m = f.number("to_m", -1.0, -1.0, 1e5);
  flow.stop_every_s = f.interval("stop_every_s", {0.0, 0.0}, 0.0, 1e5);
  flow.stop_for_s = f.interval("stop_for_s", {0.0, 0.0}, 0.0, 1e5);
  if (f.has("stop_every_s") && flow.stop_every_s.low < 1.0) {
    f.fail("stop_every_s", "at least 1 s on the way");
  }
  flow.kinds = read_kinds(f);
  return flow;
}

QueueSpec read_queue(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where,
                 "road reverse lanes_m line_m count gap_m side_m kinds arrived start_s reaction_s "
                 "speed_mps acceleration_mps2");
  QueueSpec queue;
  queue.road = f.text("road");
  queue.reverse = f.flag("reverse", false);
  queue.lanes_m = f.numbers("lanes_m");
  for (const double lane : queue.lanes_m) {
    if (!(std::abs(lane) <= 200.0)) f.fail("lanes_m", "offsets of at most 200 m");
  }
  if (queue.lanes_m.empty()) f.fail("lanes_m", "at least one lane");
  queue.line_m = f.number("line_m", 0.0, -1e5, 1e5);
  queue.count = f.integer("count", queue.count, 1, 1000);
  queue.gap_m = f.interval("gap_m", queue.gap_m, 0.1, 100.0);
  queue.side_m = f.interval("side_m", queue.side_m, -5.0, 5.0);
  queue.kinds = read_kinds(f);
  queue.arrived = f.number("arrived", queue.arrived, 0.0, 1.0);
  queue.start_s = f.number("start_s", queue.start_s, 1.0, 1e5);
  queue.reaction_s = f.interval("reaction_s", queue.reaction_s, 0.0, 60.0);
  queue.speed_mps = f.number("speed_mps", queue.speed_mps, 0.1, 60.0);
  queue.acceleration_mps2 = f.number("acceleration_mps2", queue.acceleration_mps2, 0.1, 20.0);
  return queue;
}

Air read_air(const nlohmann::json& json, const std::string& where) {
  const Fields f(json, where, "glass_through visibility_m echo_share echo_range_m");
  Air air;
  air.glass_through = f.number("glass_through", air.glass_through, 0.0, 1.0);
  air.visibility_m = f.number("visibility_m", air.visibility_m, 1.0, 1e9);
  air.echo_share = f.number("echo_share", air.echo_share, 0.0, 1.0);
  air.echo_range_m = f.number("echo_range_m", air.echo_range_m, 0.1, 1000.0);
  return air;
}

EgoSpec read_ego(const nlohmann::json& json, const std::string& where) {
  const Fields f(
      json, where,
      kRouteKeys +
          "speed body sensor_height_m sensor_forward_m sensor_left_m sensor_pitch_deg "
          "sensor_roll_deg vibration_m vibration_deg sway_m sway_deg step_hz dig_period_s");
  EgoSpec ego;
  ego.route = read_route(f, "speed");
  ego.body = f.choice("body", "car", {"car", "excavator", "none"});
  ego.sensor_height_m = f.number("sensor_height_m", ego.sensor_height_m, 0.05, 50.0);
  ego.sensor_forward_m = f.number("sensor_forward_m", 0.0, -20.0, 20.0);
  ego.sensor_left_m = f.number("sensor_left_m", 0.0, -20.0, 20.0);
  ego.sensor_pitch_rad = f.number("sensor_pitch_deg", 0.0, -90.0, 90.0) * kDegree;
  ego.sensor_roll_rad = f.number("sensor_roll_deg", 0.0, -180.0, 180.0) * kDegree;
  ego.sway_m = f.number("sway_m", 0.0, 0.0, 0.5);
  ego.sway_rad = f.number("sway_deg", 0.0, 0.0, 30.0) * kDegree;
  ego.step_hz = f.number("step_hz", ego.step_hz, 0.1, 10.0);
  ego.vibration_m = f.number("vibration_m", 0.0, 0.0, 0.5);
  ego.vibration_rad = f.number("vibration_deg", 0.0, 0.0, 10.0) * kDegree;
  ego.dig_period_s = f.number("dig_period_s", ego.dig_period_s, 2.0, 1000.0);
  return ego;
}

}  // namespace

WorldFile world_from_json(const nlohmann::json& json, const std::string& file) {
  const Fields f(json, file,
                 "description sensor scans range_m seed terrain roads rows places "
                 "movers flows queues air ego");
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
  for (const auto& [item, where] : f.list("queues")) {
    world.queues.push_back(read_queue(*item, where));
  }
  if (f.has("air")) world.air = read_air(f.member("air"), f.place("air"));
  world.ego = read_ego(f.member("ego"), f.place("ego"));
  if (world.roads.empty()) f.fail("roads", "at least one road");
  double length = 0.0;
  for (const Road& road : world.roads) length += road.path.length();
  if (length > 2.0 * kWorldReach) f.fail("roads", "at most 200 km together");
  return world;
}

}  // namespace raymoval::simulated
