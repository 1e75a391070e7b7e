// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "core/error.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/simulated.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;
using Eigen::Vector3d;

namespace {

/// Distance of a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double triangle_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                         const Vector3d& c) {
  const auto edge = [&](const Vector3d& from, const Vector3d& to) {
    const Vector3d along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).norm();
  };
  const Vector3d normal = (b - a).cross(c - a);
  const bool inside = normal.cross(b - a).dot(p - a) >= 0 && normal.cross(c - b).dot(p - b) >= 0 &&
                      normal.cross(a - c).dot(p - c) >= 0;
  if (inside) return std::abs(normal.normalized().dot(p - a));
  return std::min({edge(a, b), edge(b, c), edge(c, a)});
}

double part_distance(const Vector3d& world, const PlacedPart& part) {
  const Vector3d p = part.T_world_part.inverse() * world;
  double best = 1e9;
  for (const auto& t : part.mesh->triangles) {
    const auto corner = [&](std::size_t i) {
      return Vector3d(part.mesh->vertices[t[i]].cast<double>());
    };
    best = std::min(best, triangle_distance(p, corner(0), corner(1), corner(2)));
  }
  return best;
}

bool is_moving(std::uint32_t word) {
  return semantic_id(word) >= 252;
}

}  // namespace

TEST_CASE("every point labelled moving lies on a part of that mover", "[slow]") {
  for (const std::string scene : {"crossing", "suburb", "excavator"}) {
    SimulationOptions options;
    options.scene = scene;
    options.sensor = "vlp16";
    options.noise_free = true;
    const auto sequence = make_simulated(options);
    std::size_t moving = 0;
    for (const std::size_t index : {std::size_t{5}, std::size_t{60}}) {
      const Scan scan = sequence->load(index);
      const auto labels = sequence->labels(scan);
      const Pose T_world_sensor =
          sequence->T_sequence_world().inverse() * sequence->true_pose(index);
      std::multimap<std::uint32_t, PlacedPart> parts;
      const auto placed =
          sequence->world().parts({scan.time_s}, scan.time_s, T_world_sensor.translation(), 200.0);
      for (const auto& part : placed[0]) parts.emplace(part.label, part);
      for (std::size_t i = 0; i < scan.size(); ++i) {
        if (!is_moving(labels[i])) continue;
        const Vector3d world = T_world_sensor * scan.points[i].cast<double>();
        double best = 1e9;
        const auto [first, last] = parts.equal_range(labels[i]);
        for (auto it = first; it != last; ++it) {
          best = std::min(best, part_distance(world, it->second));
        }
        REQUIRE(best < 1e-3);
        ++moving;
      }
    }
    CHECK(moving > 300);
  }
}

TEST_CASE("an object that moves at any time is labelled moving throughout") {
  // The queue at the crossing starts at second 7: it moves in a sequence of 150 scans (15 s), and
  // is stationary in a sequence of 30 scans (3 s).
  const auto queue_label = [](std::size_t scans) {
    SimulationOptions options;
    options.scene = "crossing";
    options.scans = scans;
    const auto sequence = make_simulated(options);
    for (const MoverTruth& mover : sequence->movers(0.0)) {
      if (mover.kind == "car" && mover.speed_mps == 0.0) return mover.semantic;
    }
    return std::uint16_t{0};
  };
  CHECK(queue_label(150) == kLabelMovingCar);
  CHECK(queue_label(30) == kLabelCar);
}

TEST_CASE("a vehicle stands on its road, a kerb lies higher than the carriageway") {
  Terrain terrain;
  Road road;
  road.name = "r";
  road.path = Path({{0, 0}, {100, 0}}, false);
  road.width_m = 8.0;
  road.crown_m = 0.1;
  road.kerb_m = 0.12;
  road.sidewalk_m = 2.0;
  const Ground ground(terrain, {road}, 1);
  CHECK(ground.height({50, 0}) == Approx(0.1));
  // The crown falls with the square of the distance: a quarter of it is gone half-way out.
  CHECK(ground.height({50, 2}) == Approx(0.075));
  CHECK(ground.height({50, 5}) == Approx(0.12));
  CHECK(ground.height({50, 10}) == Approx(0.0));
  CHECK_THROWS_AS(ground.road("q"), ConfigurationError);
}

TEST_CASE("every built-in world gives a scan with ground, standing things and movers", "[slow]") {
  for (const std::string& name : simulated_scene_names()) {
    INFO(name);
    SimulationOptions options;
    options.scene = name;
    if (name != "excavator") options.sensor = "vlp16";
    const auto sequence = make_simulated(options, 2);
    const Scan scan = sequence->load(sequence->size() / 2);
    std::size_t moving = 0;
    for (const std::uint32_t word : sequence->labels(scan)) {
      CHECK((word & 0xFFFFU) != 0U);
      moving += is_moving(word) ? 1 : 0;
    }
    CHECK(scan.size() > 8000);
    CHECK(moving > 20);
    CHECK(moving < scan.size() / 2);
  }
}

TEST_CASE("a world file with a mistake is refused by name") {
  const auto message = [](const std::string& part) {
    const std::string text = R"({"roads": [{"name": "a", "points": [[0, 0], [99, 0]]}],
      "ego": {"road": "a", "speed": 5}, )" +
                             part + "}";
    try {
      const WorldFile file = world_from_json(nlohmann::json::parse(text), "w");
      const World world(file, 1, 1.0);
    } catch (const ConfigurationError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto says = [&](const std::string& part, const std::string& expected) {
    INFO(message(part));
    CHECK(message(part).find(expected) != std::string::npos);
  };
  says(R"("scans": 10)", "accepted");
  says(R"("rows": [{"road": "a", "part": "tre"}])", "tree");
  says(R"("rows": [{"road": "b", "part": "tree"}])", "no road 'b'");
  says(R"("movers": [{"kind": "car", "road": "a", "sped": 3}])", "speed");
  says(R"("movers": [{"kind": "car"}])", "either 'road' or 'points'");
  says(R"("movers": [{"kind": "car", "points": [[0, 0]]}])", "two points");
  says(R"("movers": [{"kind": "car", "road": "a", "speed": [[3, 1], [2, 1]]}])", "must grow");
  says(R"("scans": 2.5)", "whole number");
  says(R"("terrain": {"hills_m": -1})", "from 0 to 30");
  says(R"("rows": [{"road": "a", "part": "tree", "spacing_m": 0}])", "from 0.5 to 500");
}
