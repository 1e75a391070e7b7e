// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"
#include "methods/raymoval/kernels/occupancy_map.h"

namespace raymoval::raymoval_method {

/// The state of a voxel in a map.
enum class VoxelState : std::uint8_t {
  kEmpty,
  kOccupied,
  kErased,  ///< A scan saw through it.
};

/// The states of the voxels of a scan's points.
struct VoxelLookup {
  std::vector<OccupancyMap::Slot> slots;  ///< The brick of each voxel; kNoBrick if there is none.
  std::vector<VoxelState> states;
};

/// The map M of the paper, and the voxels that were seen through, which are not filled again.
/// Memory is bounded by the number of observed voxels.
class StaticMap {
 public:
  using Slot = OccupancyMap::Slot;

  explicit StaticMap(double voxel_size) : occupied_(voxel_size) {}

  [[nodiscard]] const OccupancyMap& occupied() const { return occupied_; }
  [[nodiscard]] OccupancyMap& occupied() { return occupied_; }
  /// Brick and state of each voxel, in one pass. Fast if neighbours are consecutive.
  void look_up(const std::vector<VoxelIndex>& voxels, int threads, VoxelLookup& found) const;

  /// Adds the voxels of all points that are not dynamic.
  /// @param found the result of `look_up` for them; voxels may have been erased since
  void integrate(const std::vector<VoxelIndex>& voxels, const VoxelLookup& found,
                 const Mask& dynamic);
  /// Adds all voxels, known or not. Fast if neighbours are consecutive.
  void integrate(const std::vector<VoxelIndex>& voxels);
  /// Removes a voxel that a scan saw through.
  void erase(const VoxelIndex& voxel);

 private:
  void find_slots(const std::vector<VoxelIndex>& voxels, std::size_t begin, std::size_t end,
                  std::vector<Slot>& slots) const;
  [[nodiscard]] VoxelState state(Slot slot, const VoxelIndex& voxel) const;
  /// Adds a voxel of the brick `slot`, unless it was erased.
  void integrate(Slot slot, const VoxelIndex& voxel);
  /// @param slot may be kNoBrick
  [[nodiscard]] bool was_erased(Slot slot, const VoxelIndex& voxel) const {
    const Brick* erased = erased_in(slot);
    return erased != nullptr && erased->contains(voxel.x(), voxel.y(), voxel.z());
  }
  static constexpr std::uint32_t kNothingErased = ~std::uint32_t{0};

  /// Erased voxels of a brick (`slot` may be kNoBrick); null if it has none.
  [[nodiscard]] const Brick* erased_in(Slot slot) const {
    if (slot >= erased_of_.size() || erased_of_[slot] == kNothingErased) return nullptr;
    return &erased_[erased_of_[slot]];
  }

  OccupancyMap occupied_;
  /// The index of each brick's erased voxels in `erased_`. Few bricks have any.
  std::vector<std::uint32_t> erased_of_;
  std::vector<Brick> erased_;
};

}  // namespace raymoval::raymoval_method
