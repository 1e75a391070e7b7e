// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/hmm_mos.h"

#include <catch2/catch.hpp>
#include <limits>

#include "methods/hmm_mos/moving_voxels.h"
#include "tests/methods/hmm_mos/scenes.h"
#include "tests/methods/moved_world.h"

namespace raymoval::hmm_mos_test {
using namespace raymoval::hmm_mos_method;

namespace {

Parameters sound() {
  Parameters parameters;
  parameters.public_lattice = false;
  return parameters;
}

/// Share of the removed points of a scan among those nearer than `x`, and farther, metres.
struct Shares {
  double near = 0.0, far = 0.0;
};
Shares removed_shares(const Scan& scan, const Mask& mask, double x = 3.0) {
  double near = 0.0, far = 0.0;
  Shares removed;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const bool is_near = scan.points[k].x() < x;
    (is_near ? near : far) += 1.0;
    (is_near ? removed.near : removed.far) += mask[k];
  }
  return {near == 0.0 ? 0.0 : removed.near / near, far == 0.0 ? 0.0 : removed.far / far};
}

}  // namespace

TEST_CASE("what moves before a wall goes and the wall stays", "[hmm_mos]") {
  const toy::HeldScans scans = wall_and_mover(11, 8);
  for (const bool public_lattice : {true, false}) {
    Parameters parameters;
    parameters.public_lattice = public_lattice;
    const MaskStore masks = toy::masks_of(*make_hmm_mos(parameters), scans);
    // The first six scans only fill the map.
    for (std::size_t i = 0; i < 6; ++i) CHECK(masks.get(i) == Mask(scans.load(i).size(), 0));
    for (std::size_t i = 7; i < 10; ++i) {
      const Shares shares = removed_shares(scans.load(i), masks.get(i));
      CAPTURE(public_lattice, i);
      CHECK(shares.near > 0.7);
      CHECK(shares.far == 0.0);
    }
  }
}

// The object comes to a free place in scan 7 and is stationary: from scan 12 on, its voxels have
// not changed for five scans.
TEST_CASE("what came and stands is static again after the window", "[hmm_mos]") {
  Plate plate;
  plate.first = 7;
  const toy::HeldScans scans = wall_with({plate}, 15);
  const MaskStore masks = toy::masks_of(*make_hmm_mos(sound()), scans);
  CHECK(removed_shares(scans.load(7), masks.get(7)).near > 0.9);
  CHECK(removed_shares(scans.load(10), masks.get(10)).near > 0.9);
  for (std::size_t i = 12; i < scans.size(); ++i) {
    CHECK(removed_shares(scans.load(i), masks.get(i)).near == 0.0);
  }
}

// The object is stationary and drives off in scan 8: no voxel appears at its place, but the last
// state of its voxels is free.
TEST_CASE("what left is found by the last states only", "[hmm_mos]") {
  Plate plate;
  plate.last = 7;
  const toy::HeldScans scans = wall_with({plate}, 14);
  Parameters parameters = sound();
  CHECK(toy::masks_of(*make_hmm_mos(parameters), scans).removed_count() == 0);
  parameters.offline = true;
  const MaskStore masks = toy::masks_of(*make_hmm_mos(parameters), scans);
  for (const std::size_t i : {0U, 7U}) {
    const Shares shares = removed_shares(scans.load(i), masks.get(i));
    CHECK(shares.near > 0.9);
    CHECK(shares.far == 0.0);
  }
}

TEST_CASE("a scan alone, empty scans and points that are not numbers say nothing", "[hmm_mos]") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  toy::HeldScans broken;
  broken.add({{nan, nan, nan}, {1.0F, nan, 2.0F}});
  broken.add({});
  broken.add({{3.0F, 1.0F, 0.5F}, {nan, 0.0F, 0.0F}});
  Parameters offline = sound();
  offline.offline = true;
  for (const Parameters& parameters : {Parameters{}, sound(), offline}) {
    const MaskStore masks = toy::masks_of(*make_hmm_mos(parameters), broken);
    CHECK(masks.removed_count() == 0);
    CHECK(masks.get(2).size() == 2);
    const toy::HeldScans one = wall_and_mover(1, 0);
    CHECK(toy::masks_of(*make_hmm_mos(parameters), one).removed_count() == 0);
  }
}

TEST_CASE("a least range of hmm_mos that leaves nothing is refused", "[hmm_mos]") {
  Parameters parameters;
  parameters.min_range = 8.0;
  for (const double most : {8.0, 5.0}) {
    parameters.max_range = most;
    CHECK_THROWS_WITH(make_hmm_mos(parameters),
                      Catch::Contains("hmm_mos.min_range = 8") && Catch::Contains("max_range"));
  }
  parameters.max_range = 8.5;
  CHECK_NOTHROW(make_hmm_mos(parameters));
}

TEST_CASE("equal scores have no threshold", "[hmm_mos]") {
  CHECK_FALSE(otsu_threshold({}, 100).has_value());
  CHECK_FALSE(otsu_threshold({{0, 500}}, 100).has_value());
  CHECK_FALSE(otsu_threshold({{6, 500}}, 100).has_value());
}

}  // namespace raymoval::hmm_mos_test
