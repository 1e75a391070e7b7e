// SPDX-License-Identifier: MIT
#pragma once

#include "methods/registry.h"
#include "tests/methods/toy_world.h"

namespace raymoval::raymoval_test {

using toy::Box;
using toy::pose_at;
using toy::World;

/// The static object is box 0, and the object that comes or goes before it is box 1.
inline constexpr int kWallOwner = 0;
inline constexpr int kOtherOwner = 1;

/// A wall 12 m ahead, which ends at `top`, and a box of car size 6 m ahead.
inline Box wall(double top = 3.0) {
  return {{12.03, -9, -3}, {12.5, 9, top}};
}
inline Box car(double bottom = -1.0) {
  return {{6.03, -1, bottom}, {8, 1, 0.6}};
}

/// The pose of a scan of a sensor that is off the lattice and moves slowly ahead.
inline Pose creeping(int scan) {
  return pose_at(0.013 * scan + 0.01, 0.02, 0.03);
}

/// Scans of the static object, and of a box in the scans in which it `is_there`.
template <class IsThere>
World box_before(const std::vector<Box>& standing, const Box& box, int scans, IsThere&& is_there,
                 const toy::Scanner& scanner = {}, const Pose& sensor_turn = Pose::Identity()) {
  World world(scanner);
  for (int i = 0; i < scans; ++i) {
    std::vector<Box> boxes = standing;
    if (is_there(i)) boxes.push_back(box);
    world.scan(boxes, creeping(i) * sensor_turn);
  }
  return world;
}

/// A variant with one bin per beam and two beams per bin along a row: the toy scanner needs no
/// more.
inline ConfiguredMethod on_toy_grid(const std::string& variant) {
  ConfiguredMethod method = MethodRegistry::built_in().configure("raymoval:" + variant);
  set_parameter(method.configuration, "azimuth_bins", std::int64_t{360});
  set_parameter(method.configuration, "elevation_bins", std::int64_t{44});
  return method;
}

}  // namespace raymoval::raymoval_test
