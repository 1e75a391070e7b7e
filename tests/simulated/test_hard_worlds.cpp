// SPDX-License-Identifier: MIT
// Parts of scenes unlike KITTI: queues, people who stop, objects that come and go unseen, slopes, a
// hand-held sensor, panes and drops.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"
#include "datasets/simulation/world/path.h"
#include "datasets/simulation/world/world_file.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;
using Catch::Matchers::Contains;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A world along a straight level road of 400 m, with `more` members.
WorldFile world_file(const std::string& more) {
  return world_from_json(
      nlohmann::json::parse(
          R"({"terrain": {"roughness_m": 0}, "roads": [{"name": "road", "points": [[0, 0], [400, 0]],
              "crown_m": 0, "sidewalk_m": 0}], "ego": {"road": "road"})" +
          more + "}"),
      "test.json");
}

/// Rows and columns in a window of 10 degrees that looks along x.
SensorFile window() {
  return sensor_from_text(R"({"kind": "raster", "azimuth_deg": [-5, 5], "elevation_deg": [-5, 5],
                              "columns": 100, "rows": 100, "range_m": [0.5, 150], "noise_m": 0})");
}

/// A sweep of a pane at 5 m and a wall at 10 m that fill the view.
Sweep through_pane(const Air& air) {
  World world;
  for (const auto& [range, material] :
       {std::pair{5.0, Material::kGlass}, {10.0, Material::kPerfect}}) {
    Mesh mesh;
    add_quad(mesh, {material, kLabelBuilding}, {0, -90, -90}, {0, 90, -90}, {0, 90, 90},
             {0, -90, 90});
    world.add_static(mesh, placed(range, 0, 0));
  }
  world.set_air(air);
  world.finish();
  const SensorFile sensor = window();
  const Scanner scanner(
      world, sensor, [](double) { return Isometry3d::Identity(); }, {7}, 1);
  return scanner.sweep(0);
}

std::size_t count_at(const Sweep& sweep, double x) {
  std::size_t count = 0;
  for (const auto& point : sweep.points) count += std::abs(point.x() - x) < 1e-3 ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("a queue stands bumper to bumper, comes up and leaves, and nobody drives into another") {
  QueueSpec spec;
  spec.line_m = 100.0;
  spec.gap_m = {1.0, 3.0};
  spec.arrived = 0.5;
  spec.start_s = 10.0;
  spec.reaction_s = {0.0, 1.0};
  const std::vector<double> lengths = {4.0, 2.0, 2.0, 5.0, 2.0, 4.0, 2.0, 2.0};
  Random random(3, Purpose::kQueue);
  const std::vector<QueuePlace> places = queue_places(spec, lengths, random);
  REQUIRE(places.size() == 8);
  const auto middle = [&](std::size_t i, double t) {
    return places[i].start_m + places[i].speed.distance(t);
  };
  CHECK(middle(0, 9.9) == Approx(98.0));  // its bumper at the line
  CHECK(middle(3, 0.0) == Approx(middle(3, 9.9)));
  CHECK(middle(7, 0.0) < middle(7, 9.9) - 10.0);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double room = 0.5 * (lengths[i] + lengths[i - 1]);
    const double gap = middle(i - 1, 9.9) - middle(i, 9.9) - room;
    CHECK(gap >= 1.0 - 1e-9);
    CHECK(gap <= 3.0 + 1e-9);
    for (double t = 0.0; t < 40.0; t += 0.1) {
      REQUIRE(middle(i - 1, t) - middle(i, t) >= room + gap - 1e-6);
    }
  }
  CHECK(places[0].speed.speed(10.0) == 0.0);
  CHECK(places[7].speed.speed(30.0) == Approx(spec.speed_mps));
}

TEST_CASE("a lift raises a vehicle over a ramp to a storey") {
  const WorldFile file =
      world_file(R"(, "movers": [{"kind": "car", "road": "road", "lift": [[100, 0], [120, 5]]}])");
  const Ground ground(file.terrain, file.roads, 1);
  const Track track(file.movers[0].route, ground);
  const auto height = [&](double s) { return track.frame(s, 0.0, 2.0, 1.5).translation().z(); };
  CHECK(height(90.0) == Approx(height(0.0)).margin(1e-9));
  CHECK(height(110.0) - height(0.0) == Approx(2.5));
  CHECK(height(130.0) - height(0.0) == Approx(5.0));
  const Vector3d forward = track.frame(110.0, 0.0, 2.0, 1.5).linear().col(0);
  CHECK(std::atan2(forward.z(), forward.x()) == Approx(std::atan(0.25)));
}

TEST_CASE("the garage has cars on both storeys, and the sensor climbs to the upper one") {
  SimulationOptions options;
  options.scene = "garage";
  options.sensor = "vlp16";
  options.pose_noise = 0.0;
  const auto garage = make_simulated(options, 2);
  const std::size_t last = garage->size() - 1;
  const double low = garage->pose(0).translation().z(), high = garage->pose(last).translation().z();
  CHECK(high - low == Approx(3.0).margin(0.05));
  for (const std::size_t index : {std::size_t{0}, last}) {
    // A slab is between the storeys: in view are cars on the floor of the sensor.
    const Scan scan = garage->load(index);
    const std::vector<std::uint32_t> labels = garage->labels(scan);
    std::size_t cars = 0, near = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if ((labels[i] & 0xFFFFU) != kLabelCar) continue;
      const double height = (scan.T_world_sensor * scan.points[i].cast<double>()).z() -
                            scan.T_world_sensor.translation().z() + 1.73;
      ++cars;
      near += height > -0.1 && height < 1.8 ? 1 : 0;
    }
    CHECK(cars > 200);
    CHECK(near > 0.9 * static_cast<double>(cars));
  }
}

TEST_CASE("a train is twelve cars that follow the rails") {
  Random random(1, Purpose::kMover, 1);
  const Body train = make_body("train", random);
  CHECK(train.parts.size() == 12);
  CHECK(train.length_m == Approx(117.2));
  CHECK(train.parts.front().along_m == Approx(-53.9));
  CHECK(train.parts.back().along_m == Approx(53.9));
}

TEST_CASE("a sensor in the hand sways within its bounds about the way") {
  const WorldFile file = world_file("");
  EgoSpec spec = file.ego;
  spec.body = "none";
  spec.sensor_height_m = 1.25;
  spec.sensor_pitch_rad = 0.6;
  const Ground ground(file.terrain, file.roads, 1);
  const Isometry3d still = Ego(spec, ground).sensor_pose(3.0);
  spec.sway_m = 0.03;
  spec.sway_rad = 0.1;
  const Ego walker(spec, ground);
  double most_turn = 0.0, most_shift = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.05) {
    const Isometry3d motion = still.inverse() * walker.sensor_pose(t);
    most_turn = std::max(most_turn, Eigen::AngleAxisd(motion.linear()).angle());
    most_shift = std::max(most_shift, motion.translation().norm());
  }
  CHECK(most_turn > 0.1);
  CHECK(most_turn < 0.3);  // yaw to 0.16, roll to 0.1, pitch to 0.06
  CHECK(most_shift > 0.03);
  CHECK(most_shift < 0.3);  // the turns swing a height of 1.25 m
}

TEST_CASE("a pane lets its share of shots through to what stands behind it") {
  CHECK(count_at(through_pane({}), 10.0) == 0);
  Air air;
  air.glass_through = 1.0;
  CHECK(count_at(through_pane(air), 10.0) == 10000);
  air.glass_through = 0.75;
  const Sweep sweep = through_pane(air);
  // Of 10,000 shots 7,500 pass (standard error 43); of the others 65 % leave as from a mirror.
  CHECK(std::abs(static_cast<double>(count_at(sweep, 10.0)) - 7500.0) < 200.0);
  CHECK(std::abs(static_cast<double>(count_at(sweep, 5.0)) - 2500.0 * 0.35) < 120.0);
}

TEST_CASE("drops return as outliers near the sensor, and fog hides what is far") {
  Air air;
  air.glass_through = 1.0;
  air.echo_share = 0.1;
  air.echo_range_m = 2.0;
  const Sweep sweep = through_pane(air);
  REQUIRE(sweep.points.size() == 10000);
  std::size_t drops = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (sweep.labels[i] != kLabelOutlier) continue;
    ++drops;
    sum += static_cast<double>(sweep.points[i].norm()) - 0.5;
    REQUIRE(sweep.points[i].x() < 10.0F);
  }
  // A tenth of 10,000 (standard error 30), except for the exp(-9.5 / 2) = 0.9 % behind the wall.
  CHECK(std::abs(static_cast<double>(drops) - 991.0) < 130.0);
  CHECK(sum / static_cast<double>(drops) == Approx(2.0 - 9.5 * 0.0087).epsilon(0.15));

  // Perfect walls return in any weather; grey ones behind 3 m of sight do not.
  const auto returned = [](double visibility) {
    World world;
    Mesh mesh;
    add_quad(mesh, {Material::kPlaster, kLabelBuilding}, {0, -90, -90}, {0, 90, -90}, {0, 90, 90},
             {0, -90, 90});
    world.add_static(mesh, placed(40, 0, 0));
    Air fog;
    fog.visibility_m = visibility;
    world.set_air(fog);
    world.finish();
    const SensorFile sensor = window();
    const Scanner scanner(
        world, sensor, [](double) { return Isometry3d::Identity(); }, {7}, 1);
    return scanner.sweep(0).points.size();
  };
  CHECK(returned(1e9) > 9000);
  CHECK(returned(30.0) < 200);
}

TEST_CASE("what a world file says of queues and air is checked") {
  const auto refused = [](const std::string& more, const std::string& place) {
    CHECK_THROWS_WITH(world_file(more), Contains(place));
  };
  refused(R"(, "queues": [{"road": "road", "lanes_m": [], "kinds": {"car": 1}}])", "lanes_m");
  refused(R"(, "queues": [{"road": "road", "lanes_m": [1]}])", "kinds");
  refused(R"(, "air": {"glass_through": 2})", "glass_through");
  refused(R"(, "terrain": {"slope": [1, 0]})", "slope");
  refused(R"(, "flows": [{"road": "road", "kinds": {"car": 1}, "stop_every_s": 0.1}])",
          "stop_every_s");
}
