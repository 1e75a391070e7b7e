// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

namespace raymoval::patchwork {

/// Rings from the sensor on in which a plane must prove that it is ground. Beyond, an upright one
/// is ground.
inline constexpr int kProvedRings = 4;

struct MeanAndDeviation {
  double mean = 0.0, deviation = 0.0;
};
/// The mean, and the standard deviation of a sample, which is 0 for one value.
/// @param values at least one
MeanAndDeviation mean_and_deviation(const std::deque<double>& values);

/// What planes of each of the innermost rings are compared with. It adapts after each scan.
class GroundThresholds {
 public:
  /// @param sensor_height metres above the ground; infinite where it is unknown
  explicit GroundThresholds(double sensor_height) : sensor_height_(sensor_height) {}

  [[nodiscard]] double sensor_height() const { return sensor_height_; }
  void set_sensor_height(double height) { sensor_height_ = height; }
  /// A plane whose mean height above the sensor is below this lies low enough, metres.
  [[nodiscard]] double elevation(int ring) const { return rings_.at(index(ring)).elevation; }
  /// A plane whose least variance is below this is flat enough, square metres.
  [[nodiscard]] double flatness(int ring) const { return rings_.at(index(ring)).flatness; }

  /// Remembers a plane of a ring that was low enough. The last 1,000 of each ring count.
  void store(int ring, double elevation, double flatness);
  /// Takes in what was stored. The planes of the innermost ring tell the sensor's height anew.
  void adapt();

 private:
  struct Ring {
    double elevation = 0.0, flatness = 0.0;
    std::deque<double> elevations, flatnesses;
  };
  static std::size_t index(int ring) { return static_cast<std::size_t>(ring); }

  double sensor_height_;
  std::array<Ring, kProvedRings> rings_;
};

}  // namespace raymoval::patchwork
