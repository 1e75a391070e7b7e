// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/trajectories/pose_lookup.h"

namespace raymoval {

/// A step from frame to frame: a fixed transform, or one over time.
struct ChainLink {
  Trajectory moving;              ///< Empty if the step is fixed.
  Pose fixed = Pose::Identity();  ///< Where `moving` is empty.
  bool inverse = false;           ///< Whether the step goes the other way.
};

/// The motion of a sensor along a chain of frames, from the world to the sensor. Each step is
/// interpolated on its own, for their times differ.
class ChainMotion : public SensorMotion {
 public:
  ChainMotion(std::vector<ChainLink> links, Nanoseconds time_offset, Nanoseconds max_gap)
      : links_(std::move(links)), time_offset_(time_offset), max_gap_(max_gap) {}
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp) const override;
  /// The time in which all steps are known.
  [[nodiscard]] std::pair<Nanoseconds, Nanoseconds> span() const override;
  [[nodiscard]] Nanoseconds time_offset() const override { return time_offset_; }

 private:
  std::vector<ChainLink> links_;
  Nanoseconds time_offset_, max_gap_;
};

/// A trajectory of poses in any order. Of several with one stamp the last is taken, as receivers of
/// transforms do.
Trajectory ordered_trajectory(std::vector<StampedPose> poses);

}  // namespace raymoval
