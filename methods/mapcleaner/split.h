// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "methods/mapcleaner/terrain.h"

namespace raymoval::mapcleaner_method {

/// What the terrain says of a point.
enum class Part : std::uint8_t {
  kGround,
  kBelow,      ///< It lies below the ground.
  kCandidate,  ///< It lies above the ground and may be dynamic.
  kOther,      ///< No terrain is there, and it is not judged.
};

/// Splits points by their heights above the terrain.
class Split {
 public:
  /// @param terrain must outlive this object
  Split(const Parameters& parameters, const Terrain& terrain)
      : parameters_(parameters), terrain_(terrain) {}

  /// Whether it must be known which points of a scan are ground, besides the terrain.
  [[nodiscard]] bool needs_ground() const { return !parameters_.on_terrain_only; }
  /// @param is_ground counts where there is no terrain, if `needs_ground`
  [[nodiscard]] Part part_of(const Eigen::Vector3d& world, bool is_ground,
                             Terrain::Cursor& cursor) const {
    const double height = world.z() - terrain_.height_at(world, cursor);
    if (height > parameters_.ground_height) return Part::kCandidate;
    if (height < -parameters_.ground_height) return Part::kBelow;
    if (!std::isnan(height)) return Part::kGround;
    if (!needs_ground()) return Part::kOther;
    return is_ground ? Part::kGround : Part::kCandidate;
  }

 private:
  const Parameters& parameters_;
  const Terrain& terrain_;
};

}  // namespace raymoval::mapcleaner_method
