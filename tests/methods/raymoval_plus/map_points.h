// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <string_view>
#include <vector>

#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_test {

/// The voxel of a world point (metres) in a map with voxels of 0.2 m, and where the point is in it.
struct MapPoint {
  explicit MapPoint(const Eigen::Vector3d& point) : cell(voxel_index(point, 5.0)) {
    const Eigen::Vector3d offset = 256.0 * (5.0 * point - cell.cast<double>());
    for (int axis = 2; axis >= 0; --axis) {
      parts = parts << 8U | static_cast<std::uint32_t>(offset[axis]);
    }
  }
  VoxelIndex cell;
  std::uint32_t parts = 0;
};

/// Adds world points to a map, one by one, and finds them again.
class MapPoints {
 public:
  raymoval_plus_method::EvidenceMap map{0.2};

  std::uint32_t add(const Eigen::Vector3d& point) {
    const MapPoint at(point);
    return map.add(at.cell, at.parts, cursor_);
  }
  [[nodiscard]] std::uint32_t find(const Eigen::Vector3d& point) const {
    raymoval_plus_method::EvidenceMap::Blocks::Cursor cursor;
    using raymoval_plus_method::EvidenceMap;
    const std::size_t slot = map.find_slot(MapPoint(point).cell, cursor);
    return slot == EvidenceMap::Blocks::kNoSlot ? EvidenceMap::kNone : map.voxel_in(slot);
  }

 private:
  raymoval_plus_method::EvidenceMap::Blocks::Cursor cursor_;
};

/// The evidence of scans from number `first` on, one for each letter: h hits, p passes, o is open,
/// and any other letter is of a scan that observed nothing.
inline raymoval_plus_method::VoxelEvidence evidence_of(std::string_view story,
                                                       std::size_t first = 0) {
  using raymoval_plus_method::Observation;
  raymoval_plus_method::VoxelEvidence evidence;
  for (const char seen : story) {
    const Observation observation = seen == 'h'   ? Observation::kHit
                                    : seen == 'p' ? Observation::kPassed
                                    : seen == 'o' ? Observation::kOpen
                                                  : Observation::kUnknown;
    raymoval_plus_method::add_observation(observation, first++, evidence);
  }
  return evidence;
}

/// The numbers of all blocks of a map.
inline std::vector<std::uint32_t> all_blocks(const raymoval_plus_method::EvidenceMap& map) {
  std::vector<std::uint32_t> blocks(map.blocks().block_count());
  std::iota(blocks.begin(), blocks.end(), 0U);
  return blocks;
}

}  // namespace raymoval::raymoval_plus_test
