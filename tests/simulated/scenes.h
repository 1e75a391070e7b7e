// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>

#include "datasets/simulation/scene/simulated.h"
#include "datasets/simulation/sensor/scanner.h"
#include "datasets/simulation/sensor/sensor_file.h"
#include "datasets/simulation/shapes/shapes.h"
#include "datasets/simulation/world/ground.h"
#include "datasets/simulation/world/mover.h"
#include "datasets/simulation/world/world.h"

namespace raymoval::simulated {

inline SensorFile sensor_from_text(const std::string& text) {
  return sensor_from_json(nlohmann::json::parse(text), "test");
}

/// 32 beams from 15 degrees above to 25 below, every degree around, no noise of its own.
inline SensorFile plain_sensor() {
  return sensor_from_text(R"({"banks": [{"from_deg": 15, "to_deg": -25, "count": 32}],
                              "azimuth_step_deg": 1.0, "range_m": [0.1, 200], "noise_m": 0})");
}

inline Eigen::Isometry3d tilted(const Eigen::Vector3d& at, double yaw, double pitch, double roll) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() = at;
  return pose;
}

/// A level straight road without kerbs along x, 400 m long from x = 0.
inline Ground flat_ground() {
  Terrain terrain;
  terrain.roughness_m = 0.0;
  Road road;
  road.name = "road";
  road.path = Path({{0, 0}, {400, 0}}, false);
  road.crown_m = 0.0;
  road.sidewalk_m = 0.0;
  return Ground(terrain, {road}, 1);
}

/// A box 2 m long, 2 m wide and 2 m high that follows the road at a steady speed.
inline Mover box_mover(const Ground& ground, double start, double speed) {
  Body body;
  body.static_label = kLabelCar;
  body.moving_label = kLabelMovingCar;
  body.length_m = 2.0;
  body.width_m = 2.0;
  body.parts.emplace_back();
  add_box(body.parts[0].mesh, {Material::kPerfect, 0}, {-1, -1, 0}, {1, 1, 2});
  Route route;
  route.road = "road";
  route.start_m = start;
  route.speed = SpeedProfile({{0.0, speed}});
  return Mover("car", std::move(body), Track(route, ground), 0.0, 5);
}

/// Three scans of the town with few beams.
inline SimulationOptions small_town(std::size_t scans = 3, std::uint64_t seed = 1) {
  SimulationOptions options;
  options.scene = "town";
  options.sensor = "vlp16";
  options.scans = scans;
  options.seed = seed;
  return options;
}

}  // namespace raymoval::simulated
