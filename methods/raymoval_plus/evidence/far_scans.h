// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace raymoval::raymoval_plus_method {

/// Of a voxel with which enough scans agree, how many scans saw through it from so much farther
/// than the nearest of these that they say nothing, between the first and the last that agrees. The
/// edge of a thing is half air, and from afar beams pass beside it, through what is one voxel.
/// Before the first and after the last scan that agrees, all are heard: what came or left may have
/// been looked at from afar only.
class FarFreeScans {
 public:
  /// Distances are counted in octaves from here on, metres. What is nearer is always heard.
  static constexpr std::array<float, 3> kFrom{8.0F, 16.0F, 32.0F};
  /// An octave is heard if it begins at most so many times as far as the nearest scan that agrees.
  static constexpr float kFarther = 4.0F;

  /// A scan sees through the voxel, after one that agrees.
  /// @param range distance of the voxel from the sensor, metres
  void see_through(float range) {
    const auto octave = std::upper_bound(kFrom.begin(), kFrom.end(), range) - kFrom.begin();
    if (octave > 0) add(1, since_[static_cast<std::size_t>(octave - 1)]);
  }
  /// A scan agrees with the voxel.
  void agree(float range) {
    for (std::size_t k = 0; k < kFrom.size(); ++k) add(since_[k], between_[k]);
    since_ = {};
    const auto first_unheard =
        std::upper_bound(kFrom.begin(), kFrom.end(), kFarther * range) - kFrom.begin();
    heard_ = std::min(heard_, static_cast<std::uint8_t>(first_unheard));
  }
  /// How many scans say nothing.
  [[nodiscard]] int between_agreeing() const {
    int scans = 0;
    for (std::size_t k = heard_; k < kFrom.size(); ++k) scans += between_[k];
    return scans;
  }

 private:
  static void add(std::uint16_t scans, std::uint16_t& count) {
    count = static_cast<std::uint16_t>(std::min(count + scans, 0xFFFF));
  }
  /// By octave: scans that saw through it between two that agree, and since the last one.
  std::array<std::uint16_t, 3> between_{}, since_{};
  std::uint8_t heard_ = kFrom.size();  ///< So many octaves are heard.
};

}  // namespace raymoval::raymoval_plus_method
