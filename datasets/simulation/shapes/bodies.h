// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

/// A rigid piece of a body, and its motion relative to the body.
struct BodyPart {
  enum class Joint {
    kFixed,  ///< Moves with the body.
    kSwing,  ///< A limb: swings about a hinge as the body walks (`phase` in turns).
    kCar,    ///< A tram car: follows the path `along_m` behind or before the body's centre.
  };
  Mesh mesh;  ///< Frame of the body: x forward, z up, z = 0 on the ground; metres.
  Joint joint = Joint::kFixed;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< Of a limb; its axis is y.
  double amplitude = 0.0;                           ///< Of a limb at walking pace, radians.
  double phase = 0.0;
  double along_m = 0.0;
};

/// An object that can be stationary or move: its parts, labels, length and width.
struct Body {
  std::vector<BodyPart> parts;
  std::uint16_t static_label = kLabelOtherObject;
  std::uint16_t moving_label = kLabelMovingOtherVehicle;
  double length_m = 1.0;
  double width_m = 1.0;
  double stride_m = 1.4;  ///< Distance of one swing of the limbs.
  double pace_mps = 1.3;  ///< Speed at which limbs swing fully.
};

/// Names for `make_body`, such as car, scooter and pedestrian.
const std::vector<std::string>& body_kinds();

/// One individual of `kind`; size, shape and paint vary with `random`.
/// @throws ConfigurationError for an unknown kind, suggesting the nearest one.
Body make_body(const std::string& kind, Random& random);

/// All parts at rest in one mesh, each triangle labelled `label`: for a parked car.
Mesh resting_mesh(const Body& body, std::uint32_t label);

/// A paint without a label: the label of a body depends on its motion.
constexpr Paint paint_of(Material material) {
  return {material, 0};
}
/// A body with one fixed part, still empty. @param length, width metres
Body body_of(std::uint16_t standing, std::uint16_t moving, double length, double width);
/// A bicycle without its rider.
void add_bicycle(Mesh& mesh);
Body make_person(Random& random);
Body make_cyclist(Random& random);
Body make_motorcyclist(Random& random);
/// A motor scooter: smaller than a motorcycle, with a board for the feet.
Body make_scooter_rider(Random& random);

}  // namespace raymoval::simulated
