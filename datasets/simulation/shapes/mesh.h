// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace raymoval::simulated {

/// The material of a surface.
enum class Material : std::uint8_t {
  kAsphalt,
  kConcrete,
  kGrass,
  kSoil,
  kPlaster,
  kBrick,
  kRoof,
  kGlass,
  kBrightPaint,
  kDarkPaint,
  kRubber,
  kMetal,
  kWood,
  kLeaf,
  kCloth,
  kSkin,
  kSign,
  kPolish,   ///< Of the ego vehicle.
  kPerfect,  ///< Always returns, at any range: for tests.
};

struct MaterialProperties {
  double reflectivity;  ///< Diffuse, at 905 nm, 0 .. 1.
  double mirror;        ///< Share of shots that are reflected like by a mirror, without return.
};
const MaterialProperties& properties(Material material);

/// Semantic ids of SemanticKITTI that the simulator uses.
enum Label : std::uint16_t {
  kLabelOutlier = 1,  ///< The ego vehicle.
  kLabelCar = 10,
  kLabelBicycle = 11,
  kLabelBus = 13,
  kLabelTram = 16,
  kLabelTruck = 18,
  kLabelOtherVehicle = 20,
  kLabelPerson = 30,
  kLabelBicyclist = 31,
  kLabelMotorcyclist = 32,
  kLabelRoad = 40,
  kLabelSidewalk = 48,
  kLabelOtherGround = 49,
  kLabelBuilding = 50,
  kLabelFence = 51,
  kLabelOtherStructure = 52,
  kLabelVegetation = 70,
  kLabelTrunk = 71,
  kLabelTerrain = 72,
  kLabelPole = 80,
  kLabelTrafficSign = 81,
  kLabelOtherObject = 99,
  kLabelMovingCar = 252,
  kLabelMovingBicyclist = 253,
  kLabelMovingPerson = 254,
  kLabelMovingMotorcyclist = 255,
  kLabelMovingTram = 256,
  kLabelMovingBus = 257,
  kLabelMovingTruck = 258,
  kLabelMovingOtherVehicle = 259,
};

/// Material and label word (instance << 16 | semantic) of a surface.
struct Paint {
  Material material = Material::kPerfect;
  std::uint32_t label = 0;
};

/// Triangles in metres in a nearby frame; both sides of a triangle return light.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Paint> paints;  ///< One per triangle.

  [[nodiscard]] bool empty() const { return triangles.empty(); }
  std::uint32_t vertex(const Eigen::Vector3d& position) {
    vertices.push_back(position.cast<float>());
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Paint paint) {
    triangles.push_back({a, b, c});
    paints.push_back(paint);
  }
  /// Adds `other` moved by `motion`, computed in double precision.
  void append(const Mesh& other, const Eigen::Isometry3d& motion);
};

}  // namespace raymoval::simulated
