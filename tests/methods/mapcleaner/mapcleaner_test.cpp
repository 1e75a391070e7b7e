// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/mapcleaner.h"

#include <oneapi/tbb/global_control.h>
#include <catch2/catch.hpp>

#include "tests/methods/mapcleaner/oracle.h"
#include "tests/methods/mapcleaner/scenes.h"
#include "tests/methods/moved_world.h"

namespace raymoval::mapcleaner_test {
using namespace raymoval::mapcleaner_method;

namespace {

/// Ground is known below the sensor itself, as where it drove before.
Parameters here() {
  Parameters parameters;
  parameters.ground_min_range = 0.3;
  return parameters;
}

Parameters sound() {
  Parameters parameters;
  parameters.public_height = parameters.public_axes = false;
  parameters.public_field_of_view = parameters.public_overwrite = parameters.public_steps = false;
  parameters.remove_below = false;
  parameters.start_radius = 12.4;
  return parameters;
}

/// How many of the last points of scan 0 go.
int removed_of_last(const ScanSource& scans, std::size_t points, const Parameters& parameters) {
  const Mask mask = toy::masks_of(*make_mapcleaner(parameters), scans).get(0);
  int removed = 0;
  for (std::size_t i = mask.size() - points; i < mask.size(); ++i) removed += mask[i];
  return removed;
}

/// Ground, a wall at 11 m, and `more` before it: the last point of a pixel counts.
WorldPoints street_with(const WorldPoints& more, const WorldPoints& ground = level_ground()) {
  WorldPoints points = ground;
  add_face(11.0, 0.05, 4.5, points);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

/// A scan of the street with something, and two without.
toy::HeldScans passing(const WorldPoints& more) {
  toy::HeldScans scans;
  scans.add_world(kSensor, street_with(more));
  scans.add_world(kSensor, street_with({}));
  scans.add_world(kSensor, street_with({}));
  return scans;
}

}  // namespace

TEST_CASE("mapcleaner: what more scans see through than see goes") {
  WorldPoints box;
  add_face(6.0, 1.8, 2.9, box);
  for (const Parameters& parameters : {here(), sound()}) {
    const toy::HeldScans scans = passing(box);
    const MaskStore masks = toy::masks_of(*make_mapcleaner(parameters), scans);
    CHECK(removed_of_last(scans, box.size(), parameters) == static_cast<int>(box.size()));
    CHECK(masks.removed_count() == box.size());
  }
  SECTION("one that sees it and one that does not are no majority") {
    toy::HeldScans scans;
    scans.add_world(kSensor, street_with(box));
    scans.add_world(kSensor, street_with({}));
    CHECK(removed_of_last(scans, box.size(), here()) == 0);
  }
  SECTION("what stands stays, and so does what is hidden") {
    WorldPoints both;
    add_face(8.0, 1.9, 2.5, both);
    both.insert(both.end(), box.begin(), box.end());  // It hides the other.
    toy::HeldScans scans;
    scans.add_world(kSensor, street_with(both));
    for (int i = 0; i < 3; ++i) scans.add_world(kSensor, street_with(box));
    CHECK(removed_of_last(scans, both.size(), here()) == 0);
  }
}

TEST_CASE("mapcleaner: what is near the terrain stays, whatever scans say") {
  WorldPoints low;
  for (int i = 0; i < 10; ++i) low.emplace_back(6.0 + 0.2 * i, 0.1, 0.16);
  CHECK(removed_of_last(passing(low), low.size(), here()) == 0);
  for (Eigen::Vector3d& point : low) point.z() = 0.3;
  CHECK(removed_of_last(passing(low), low.size(), here()) > 0);
}

TEST_CASE("mapcleaner: below the terrain, and without terrain, nothing is voted") {
  WorldPoints points;
  for (int i = 0; i < 5; ++i) points.emplace_back(5.0 + 0.2 * i, 0.1, -0.3);
  for (int i = 0; i < 5; ++i) points.emplace_back(20.0, 0.1 * i, 1.0);
  const toy::HeldScans scans = passing(points);
  for (const bool below : {false, true}) {
    Parameters parameters = here();
    parameters.remove_below = below;
    const Mask mask = toy::masks_of(*make_mapcleaner(parameters), scans).get(0);
    const auto last = mask.end() - 10;
    for (int i = 0; i < 5; ++i) CHECK((last[i] != 0) == below);
    for (int i = 5; i < 10; ++i) CHECK(last[i] == 0);
  }
}

TEST_CASE("mapcleaner: one scan, empty scans, no ground at all") {
  WorldPoints box;
  add_face(6.0, 1.8, 2.9, box);
  for (const Parameters& parameters : {here(), sound(), Parameters{}}) {
    toy::HeldScans scans;
    scans.add_world(kSensor, street_with(box));
    CHECK(toy::masks_of(*make_mapcleaner(parameters), scans).removed_count() == 0);
    scans.add({});
    CHECK(toy::masks_of(*make_mapcleaner(parameters), scans).removed_count() == 0);
    toy::HeldScans bare;
    bare.add_world(kSensor, box);
    bare.add_world(kSensor, {});
    CHECK(toy::masks_of(*make_mapcleaner(parameters), bare).removed_count() == 0);
  }
}

TEST_CASE("mapcleaner: the terrain may begin beside a sensor that sees none below itself") {
  WorldPoints box;
  add_face(6.0, 1.8, 2.9, box);
  // The sensor is stationary: its blind circle of 2.7 m is filled by 1 m only.
  Parameters parameters;
  CHECK(removed_of_last(passing(box), box.size(), parameters) == 0);
  parameters.start_radius = 1.5;
  CHECK(removed_of_last(passing(box), box.size(), parameters) == 0);
  parameters.start_radius = 2.7;
  CHECK(removed_of_last(passing(box), box.size(), parameters) == static_cast<int>(box.size()));
}

TEST_CASE("mapcleaner: a sensor that is carried low and tilted needs no settings") {
  // 0.9 m above the ground, pitched by 25 degrees.
  const Pose pose = Pose(Eigen::Translation3d(0.05, 0.05, 0.9)) *
                    Pose(Eigen::AngleAxisd(25 * kDegree, Eigen::Vector3d::UnitY()));
  WorldPoints box;
  add_face(6.0, 1.0, 2.0, box);
  toy::HeldScans scans;
  scans.add_world(pose, street_with(box));
  for (int i = 0; i < 2; ++i) scans.add_world(pose, street_with({}));
  CHECK(removed_of_last(scans, box.size(), sound()) == static_cast<int>(box.size()));
}

TEST_CASE("mapcleaner: a sensor on a slope of 30 percent has a terrain") {
  const WorldPoints hill = ground([](double, double y) { return 0.3 * y; });
  WorldPoints wall, box;
  add_face(11.0, 0.8, 4.5, wall);
  add_face(6.0, 1.8, 2.9, box);
  toy::HeldScans scans;
  for (int i = 0; i < 3; ++i) {
    WorldPoints points = hill;
    points.insert(points.end(), wall.begin(), wall.end());
    if (i == 0) points.insert(points.end(), box.begin(), box.end());
    scans.add_world(kSensor, points);
  }
  const MaskStore masks = toy::masks_of(*make_mapcleaner(sound()), scans);
  CHECK(removed_of_last(scans, box.size(), sound()) == static_cast<int>(box.size()));
  CHECK(masks.removed_count() == box.size());
  // As published all of it is too steep.
  CHECK(removed_of_last(scans, box.size(), here()) == 0);
}

TEST_CASE("mapcleaner: values that would silently leave no terrain are refused") {
  const MethodEntry entry = mapcleaner_entry();
  for (const auto& [name, value] :
       {std::pair{"terrain_variance", "0"}, {"terrain_slope", "0"}, {"upright", "1"}}) {
    const ParameterSpec& spec = find_parameter("mapcleaner", entry.parameters, name);
    CHECK_THROWS_WITH(checked_value_from_text("mapcleaner", spec, value), Catch::Contains(name));
  }
  // The least and the most that are legal work, and 90 degrees let all pass.
  WorldPoints box;
  add_face(6.0, 1.8, 2.9, box);
  Parameters parameters = here();
  parameters.terrain_variance = 1e-6;
  parameters.terrain_slope = 0.1;
  parameters.upright = 0.999;
  CHECK(removed_of_last(passing(box), box.size(), parameters) == static_cast<int>(box.size()));
  parameters.terrain_slope = 90.0;
  CHECK(removed_of_last(passing(box), box.size(), parameters) == static_cast<int>(box.size()));
}

TEST_CASE("mapcleaner: the fast way gives what the description says") {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  SensorModel sensor;
  sensor.elevation_min = -40 * kDegree;
  sensor.elevation_max = 30 * kDegree;
  std::mt19937 random(4);
  for (int variant = 0; variant < 6; ++variant) {
    Parameters parameters = variant % 2 == 0 ? here() : sound();
    if (variant > 1) {
      for (bool Parameters::*flag :
           {&Parameters::public_overwrite, &Parameters::public_field_of_view,
            &Parameters::remove_below, &Parameters::public_steps}) {
        parameters.*flag = random() % 2 == 0;
      }
      parameters.submap_radius = variant == 3 ? 6.0 : 70.0;
      parameters.submap_travel = variant == 3 ? 0.6 : 10.0;
      parameters.window_columns = static_cast<int>(random() % 4);
      parameters.refill_deviation = variant == 4 ? 0.05 : 0.5;
      parameters.tolerance = variant == 5 ? 0.2 : 0.5;
    }
    sensor.elevation_step = variant > 2 ? 1.8 * kDegree : 0.0;
    sensor.azimuth_step = variant > 3 ? 1.1 * kDegree : 0.0;
    INFO("variant " << variant);
    const toy::HeldScans scans = random_scans(20 + static_cast<unsigned>(variant), sensor);
    const Oracle oracle(parameters, scans);
    const MaskStore masks = toy::masks_of(*make_mapcleaner(parameters), scans, 1 + variant % 3);
    for (std::size_t i = 0; i < scans.size(); ++i) CHECK(masks.get(i) == oracle.mask(i));
    CHECK(masks.removed_count() > 100);
    CHECK(masks.removed_count() < masks.point_count() / 2);
  }
}

}  // namespace raymoval::mapcleaner_test
