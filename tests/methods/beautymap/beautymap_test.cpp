// SPDX-License-Identifier: MIT
#include "methods/beautymap/beautymap.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/beautymap/column_map.h"
#include "tests/methods/beautymap/oracle.h"
#include "tests/methods/moved_world.h"

namespace raymoval::beautymap_test {

namespace {

Parameters sound() {
  Parameters parameters;
  parameters.public_lattice = parameters.public_outliers = false;
  parameters.public_rays = parameters.public_top = false;
  return parameters;
}

/// Points in the middle of column (x, y), at these heights.
void stand(std::vector<Eigen::Vector3d>& points, int x, int y, const std::vector<double>& heights) {
  for (const double z : heights) points.emplace_back(x + 0.5, y + 0.5, z);
}

/// Level ground of 41 x 41 columns around the origin, a point in the middle of each.
std::vector<Eigen::Vector3d> ground() {
  std::vector<Eigen::Vector3d> points;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) stand(points, x, y, {0.01});
  }
  return points;
}

/// A mast behind the sensor, so that its steepest ray is steep: 8 m high at 6 m, from 1.7 m.
void add_mast(std::vector<Eigen::Vector3d>& points) {
  for (int i = 0; i < 16; ++i) points.emplace_back(-5.5, 0.5, 0.2 + 0.5 * i);
}

const Eigen::Vector3d kSensor(0.5, 0.5, 1.7);

/// Two scans of ground and mast; the first one has points more.
toy::HeldScans with_and_without(const std::vector<Eigen::Vector3d>& more) {
  std::vector<Eigen::Vector3d> empty = ground();
  add_mast(empty);
  std::vector<Eigen::Vector3d> full = more;
  full.insert(full.end(), empty.begin(), empty.end());
  toy::HeldScans scans;
  scans.add_world(kSensor, full);
  scans.add_world(kSensor, empty);
  return scans;
}

/// How many of the first scan's first points go.
int removed_of(const toy::HeldScans& scans, std::size_t first_points,
               const Parameters& parameters) {
  const MaskStore masks = toy::masks_of(*make_beautymap(parameters), scans);
  const Mask mask = masks.get(0);
  int removed = 0;
  for (std::size_t k = 0; k < first_points; ++k) removed += mask[k];
  return removed;
}

}  // namespace

TEST_CASE("beautymap: what stood in a column that a scan sees empty goes, but for its ground") {
  std::vector<Eigen::Vector3d> person;
  stand(person, 8, 3, {0.6, 0.8, 1.1, 1.4, 1.7});
  for (const Parameters& parameters : {Parameters{}, sound()}) {
    const toy::HeldScans scans = with_and_without(person);
    CHECK(removed_of(scans, 5, parameters) == 5);
    const MaskStore masks = toy::masks_of(*make_beautymap(parameters), scans);
    CHECK(masks.removed_count() == 5);
  }
}

TEST_CASE("beautymap: what a scan cannot see stays") {
  std::vector<Eigen::Vector3d> person;
  stand(person, 12, 0, {0.6, 1.1});
  std::vector<Eigen::Vector3d> empty = ground(), full = person;
  add_mast(empty);
  full.insert(full.end(), empty.begin(), empty.end());
  // A wall is on the way in the second scan, from the ground to 2.6 m.
  stand(empty, 6, 0, {0.2, 0.6, 1.1, 1.6, 2.1, 2.6});
  toy::HeldScans hidden;
  hidden.add_world(kSensor, full);
  hidden.add_world(kSensor, empty);
  CHECK(removed_of(hidden, 2, sound()) == 0);
  CHECK(removed_of(hidden, 2, Parameters{}) == 0);
  // Beside the way it hides nothing.
  CHECK(removed_of(with_and_without(person), 2, sound()) == 2);
  SECTION("where it has nothing around the sensor at all") {
    toy::HeldScans scans;
    std::vector<Eigen::Vector3d> points = person;
    for (const Eigen::Vector3d& point : ground()) points.push_back(point);
    scans.add_world(kSensor, points);
    scans.add_world(kSensor, {{30.5, 0.5, 9.0}});
    CHECK(removed_of(scans, 2, sound()) == 0);
    CHECK(removed_of(scans, 2, Parameters{}) == 0);
    // One point within the window is enough to be asked.
    scans.add_world(kSensor, {{-5.5, 0.5, 3.0}});
    CHECK(removed_of(scans, 2, sound()) == 2);
  }
  SECTION("near the sensor") {
    std::vector<Eigen::Vector3d> near;
    stand(near, 2, 0, {0.6, 1.1});
    CHECK(removed_of(with_and_without(near), 2, sound()) == 0);
    near.clear();
    stand(near, 4, 0, {0.6, 1.1});
    CHECK(removed_of(with_and_without(near), 2, sound()) == 2);
  }
  SECTION("beyond the window") {
    std::vector<Eigen::Vector3d> far;
    stand(far, 19, 0, {0.6, 1.1});
    CHECK(removed_of(with_and_without(far), 2, sound()) == 2);
    Parameters narrow = sound();
    narrow.window_side = 36.0;
    CHECK(removed_of(with_and_without(far), 2, narrow) == 0);
  }
  SECTION("above the steepest ray") {
    // Without the mast, no ray points up: no point above the sensor is judged.
    std::vector<Eigen::Vector3d> flat = ground(), tall = {{8.5, 3.5, 0.6}, {8.5, 3.5, 3.6}};
    tall.insert(tall.end(), flat.begin(), flat.end());
    stand(tall, 8, 3, {1.1, 1.6, 2.1, 2.6, 3.1});
    toy::HeldScans scans;
    scans.add_world(kSensor, tall);
    scans.add_world(kSensor, flat);
    Parameters parameters = sound();
    const MaskStore masks = toy::masks_of(*make_beautymap(parameters), scans);
    CHECK(masks.get(0)[0] == 1);
    CHECK(masks.get(0)[1] == 0);
  }
}

TEST_CASE("beautymap: the fast way gives what the description says") {
  std::mt19937 random(11);
  for (const unsigned seed : {3U, 8U}) {
    const toy::World street = toy::street(4, seed);
    for (int variant = 0; variant < 6; ++variant) {
      Parameters parameters = variant == 1 ? sound() : Parameters{};
      if (variant > 1) {
        parameters.public_lattice = random() % 2 == 0;
        parameters.public_outliers = random() % 2 == 0;
        parameters.public_rays = random() % 2 == 0;
        parameters.public_top = random() % 2 == 0;
        parameters.column_size = variant == 5 ? 0.7 : 1.0;
        parameters.slice_height = variant == 4 ? 0.2 : 0.5;
        parameters.window_side = variant == 3 ? 60.0 : 40.0;
      }
      INFO("seed " << seed << ", variant " << variant);
      const Oracle oracle(parameters, street);
      const MaskStore masks = toy::masks_of(*make_beautymap(parameters), street, 2);
      for (std::size_t i = 0; i < street.size(); ++i) CHECK(masks.get(i) == oracle.mask(i));
      CHECK(masks.removed_count() > 0);
    }
  }
}

}  // namespace raymoval::beautymap_test
