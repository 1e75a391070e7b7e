// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulated/scenes.h"

using namespace raymoval;
using namespace raymoval::simulated;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// A wall `range` metres ahead that fills the view of a forward-looking window.
Sweep sweep_of_wall(const SensorFile& sensor, double range, Material material) {
  World world;
  Mesh mesh;
  add_quad(mesh, {material, kLabelBuilding}, {0, -90, -90}, {0, 90, -90}, {0, 90, 90},
           {0, -90, 90});
  world.add_static(mesh, placed(range, 0, 0));
  world.finish();
  const Scanner scanner(
      world, sensor, [](double) { return Isometry3d::Identity(); }, {7}, 1);
  return scanner.sweep(0);
}

SensorFile window(const std::string& more) {
  return sensor_from_text(R"({"kind": "raster", "azimuth_deg": [-5, 5], "elevation_deg": [-5, 5],
                              "columns": 100, "rows": 100, "range_m": [0.5, 150])" +
                          more + "}");
}

}  // namespace

TEST_CASE("ranges scatter by the stated noise around the truth") {
  const Sweep sweep = sweep_of_wall(window(R"(, "noise_m": 0.03)"), 10.0, Material::kPerfect);
  REQUIRE(sweep.points.size() == 10000);
  double sum = 0.0;
  double squares = 0.0;
  for (const auto& point : sweep.points) {
    const Vector3d p = point.cast<double>();
    const double error = p.norm() - 10.0 * p.norm() / p.x();  // a ray meets x = 10 at 10 / cos
    sum += error;
    squares += error * error;
  }
  // Standard errors over 10,000 points: 0.0003 m of the mean, 0.7 % of the deviation.
  CHECK(std::abs(sum / 1e4) < 0.0012);
  CHECK(std::sqrt(squares / 1e4) == Approx(0.03).epsilon(0.04));
}

TEST_CASE("drop-out grows with range, grazing angle and darkness, and glass hardly returns") {
  const SensorFile sensor = window(R"(, "dropout": 0.02, "range_at_10_percent_m": 60)");
  const auto returned = [&](double range, Material material) {
    return static_cast<double>(sweep_of_wall(sensor, range, material).points.size()) / 1e4;
  };
  // Only the plain loss of 2 % close by; 1 - mirror times that for glass.
  CHECK(returned(5.0, Material::kPlaster) == Approx(0.98).margin(0.01));
  CHECK(returned(5.0, Material::kGlass) == Approx(0.98 * 0.35).margin(0.02));
  // Brick (30 %) returns half as often as not where its light is that of 10 % at 60 m:
  // 60 * sqrt(3) = 103.9 m.
  CHECK(returned(103.9, Material::kBrick) == Approx(0.49).margin(0.03));
  CHECK(returned(103.9, Material::kRubber) < 0.05);
  CHECK(returned(140.0, Material::kBrick) < returned(103.9, Material::kBrick));
}

TEST_CASE("a wide beam at an edge returns ranges between near surfaces, a thin one never") {
  // A step of 0.4 m: shorter than the pulse (0.75 m), so a beam that meets both blends them.
  World world;
  Mesh mesh;
  const Paint paint{Material::kPerfect, kLabelBuilding};
  add_quad(mesh, paint, {10, 0, -9}, {10, 9, -9}, {10, 9, 9}, {10, 0, 9});
  add_quad(mesh, paint, {10.4, -9, -9}, {10.4, 9, -9}, {10.4, 9, 9}, {10.4, -9, 9});
  world.add_static(mesh, Isometry3d::Identity());
  world.finish();
  const auto between = [&](const std::string& divergence) {
    const SensorFile sensor =
        window(R"(, "noise_m": 0, "pulse_m": 0.75, "divergence_mrad": )" + divergence);
    const Scanner scanner(
        world, sensor, [](double) { return Isometry3d::Identity(); }, {3}, 1);
    int count = 0;
    for (const auto& p : scanner.sweep(0).points) count += p.x() > 10.05F && p.x() < 10.35F;
    return count;
  };
  CHECK(between("0") == 0);
  // 100 rows, one direction each within 1.75 mrad of the edge.
  CHECK(between("3") > 20);
}
