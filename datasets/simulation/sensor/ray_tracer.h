// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/world/mover.h"
#include "datasets/simulation/world/world.h"

namespace raymoval::simulated {

/// A ray from a sensor. World axes; `origin` relative to the moment's centre.
struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction;  ///< Unit.
  float time = 0.0F;          ///< 0 .. 1 within the moment.
};

/// The first hit of a ray.
struct Hit {
  double range = -1.0;  ///< Metres from the ray's origin; negative = nothing.
  double cosine = 1.0;  ///< Of the angle between ray and surface normal.
  Material material = Material::kPerfect;
  std::uint32_t label = 0;
  [[nodiscard]] bool found() const { return range >= 0.0; }
};

/// Traces rays against the static tiles of a world (prepared once) and moving parts (per moment).
/// Embree finds the triangle in single precision relative to the sensor; the range is then computed
/// in double precision from the triangle, so it is exact to 0.01 mm and does not depend on the
/// processor's instruction set.
class RayTracer {
 public:
  /// @param world must outlive the tracer
  /// @param reach tiles and rays farther than this (metres) are left out
  RayTracer(const World& world, double reach, int threads);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  /// The world around `centre` with its parts at the places `samples`: one list of parts for a
  /// frozen moment, or several at equal time steps with the same parts in the same order.
  class Moment {
   public:
    Moment(const RayTracer& tracer, const Eigen::Vector3d& centre,
           std::vector<std::vector<PlacedPart>> samples);
    ~Moment();
    Moment(const Moment&) = delete;
    Moment& operator=(const Moment&) = delete;
    /// @param hits as long as `rays`
    void trace(std::span<const Ray> rays, std::span<Hit> hits) const;

   private:
    struct State;
    std::unique_ptr<State> state_;
  };

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace raymoval::simulated
