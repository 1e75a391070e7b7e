// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "datasets/simulation/sensor/ray_tracer.h"
#include "datasets/simulation/sensor/rolling.h"
#include "datasets/simulation/sensor/sensor_file.h"
#include "datasets/simulation/world/world.h"

namespace raymoval::simulated {

/// The points of one sweep, in the sensor's frame at the reference time.
struct Sweep {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> reflectance;
  std::vector<std::uint32_t> labels;
};

/// Simulates sweeps of a sensor in a world. Sweep i depends only on i and the constructor's
/// arguments.
class Scanner {
 public:
  struct Options {
    std::uint64_t seed = 1;
    Rolling rolling = Rolling::kNone;
    bool noise_free = false;  ///< Perfect ranges, no beam width, no loss except by range limits.
  };
  using SensorPose = std::function<Eigen::Isometry3d(double)>;  ///< T_world_sensor at a time.

  /// @param world, sensor must outlive the scanner
  Scanner(const World& world, const SensorFile& sensor, SensorPose pose, Options options,
          int threads);
  /// Thread-safe.
  [[nodiscard]] Sweep sweep(std::size_t index) const;

 private:
  struct Aim {
    std::vector<Shot> shots;
    std::vector<Ray> rays;
    std::vector<Eigen::Isometry3d> frames;  ///< T_reference_sensor at the rolling samples.
  };
  [[nodiscard]] Aim aim(std::size_t index) const;
  [[nodiscard]] Eigen::Isometry3d motion_at(const Aim& aim, double time_s) const;
  [[nodiscard]] Eigen::Vector3d point_of(const Aim& aim, std::size_t shot, double range) const;
  void widen(const RayTracer::Moment& moment, const Aim& aim, std::size_t index,
             std::vector<Hit>& hits) const;
  void pass_glass(const RayTracer::Moment& moment, const std::vector<Ray>& rays, std::size_t index,
                  std::uint64_t salt, std::vector<Hit>& hits) const;
  [[nodiscard]] std::optional<double> echo(const Hit& hit, std::size_t index,
                                           std::size_t shot) const;
  [[nodiscard]] Hit blend(const Hit* beams, std::size_t count) const;
  [[nodiscard]] double signal(const Hit& hit) const;
  [[nodiscard]] bool returns(const Hit& hit, std::uint64_t word) const;

  const World& world_;
  const SensorFile& sensor_;
  SensorPose pose_;
  Options options_;
  RayTracer tracer_;
};

}  // namespace raymoval::simulated
