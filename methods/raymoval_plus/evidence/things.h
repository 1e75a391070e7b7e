// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "methods/raymoval_plus/evidence/evidence_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// The scans from the first to the last hit of a voxel, or of the voxels of a thing.
struct Presence {
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), last = 0;
  [[nodiscard]] bool is_any() const { return first <= last; }
};

/// A region of blocks and the cells around it that may be of things in it. The voxels of a thing
/// are those at most 0.6 m away along a straight line whose first hits and last hits are together
/// at most five scans apart and a tenth of the time of both: a thing that turns, sways or comes
/// into sight hits some of its voxels later than others. If no scan hit a voxel, all that were hit
/// near it may be of its thing.
class Surroundings {
 public:
  /// @param voxel_size metres
  explicit Surroundings(double voxel_size);

  /// The region that a block lies in, given its block indices.
  static VoxelIndex region_of(const VoxelIndex& block) {
    return {block.x() >> kRegionShift, block.y() >> kRegionShift, block.z() >> kRegionShift};
  }
  /// Reads the voxels of a block's region and around it, if another region was read last.
  void look_at(std::uint32_t block, const EvidenceMap& map);
  /// The scans in which the thing at a cell of the region was there.
  [[nodiscard]] Presence presence_of_thing(const VoxelIndex& cell) const;
  /// The mean of `VoxelEvidence::passes_outside` over its voxels.
  [[nodiscard]] float passes_of_thing(const VoxelIndex& cell, const EvidenceMap& map) const;

 private:
  /// A region has 2^`kRegionShift` blocks a side.
  static constexpr int kRegionShift = 1;
  static constexpr int kBlockSide = EvidenceMap::Blocks::kSideXY,
                       kSide = kBlockSide << kRegionShift;
  void read_block(const VoxelIndex& index, const EvidenceMap& map);
  [[nodiscard]] std::size_t place(const VoxelIndex& cell) const {
    return static_cast<std::size_t>((cell.z() * side_ + cell.y()) * side_ + cell.x());
  }
  template <class Visit>
  void for_cells_of_thing(const VoxelIndex& cell, Visit&& visit) const;

  int reach_, side_;
  std::optional<VoxelIndex> region_;        ///< The one that was read last.
  VoxelIndex corner_ = VoxelIndex::Zero();  ///< The lowest of the cells.
  std::vector<Presence> presences_;         ///< Of each cell, x fastest, then y.
  std::vector<std::uint32_t> voxels_;
  std::vector<std::size_t> steps_;  ///< To the cells that may be of the same thing.
};

/// Step 6: finds `VoxelEvidence::passes_outside` of the voxels of some blocks. What stands has next
/// to none of them; the passes that a voxel alone counts are also of beams beside its points.
void find_passes_outside(std::vector<std::uint32_t> blocks, const RunContext& context,
                         EvidenceMap& map);

}  // namespace raymoval::raymoval_plus_method
