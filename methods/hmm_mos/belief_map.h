// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/scan/cell_set.h"
#include "methods/common/workspaces.h"
#include "methods/hmm_mos/belief.h"
#include "methods/hmm_mos/distances.h"
#include "methods/hmm_mos/scan_voxels.h"

namespace raymoval::hmm_mos_method {

/// What is believed of the voxels around the sensor that were observed lately.
class BeliefMap {
 public:
  explicit BeliefMap(const Parameters& parameters);

  /// Steps 3 and 4 for the observed voxels of a scan.
  /// @param before the scan before; empty if there is none
  void observe(const ScanVoxels& now, const ScanVoxels& before, const RunContext& context);
  /// The voxels that are occupied in the scan observed last and were free before.
  [[nodiscard]] const std::vector<VoxelIndex>& appeared() const { return appeared_; }
  /// Step 5: forgets voxels that are far from the sensor or were not seen for long, after each
  /// scan.
  /// @param sensor world position, metres
  void forget(const Eigen::Vector3d& sensor);

  /// Of a column of voxels, those whose state is known: occupied or free.
  [[nodiscard]] std::uint64_t known(const VoxelIndex& block, std::size_t column) const {
    const auto found = blocks_.find(voxel_key(block));
    return found == blocks_.end() ? 0 : found->second->known[column];
  }
  /// Forgets all voxels, after the last scan.
  void forget_all();
  /// The voxels that were free when they were last forgotten; none unless `offline`.
  [[nodiscard]] const CellSet& forgotten_free() const { return forgotten_free_; }
  /// How many voxels are in the map, for tests. The time grows with the map.
  [[nodiscard]] std::size_t size() const;

 private:
  static constexpr int kBrickBits = 3;
  static constexpr int kBrickSide = 1 << kBrickBits;
  static constexpr std::size_t kBrickVoxels = 512;
  static constexpr std::size_t kBricks = 128;  ///< Of a block.
  using ScanNumber = std::uint32_t;            ///< Counted from 1; 0 is never.

  /// 8 x 8 x 8 voxels.
  struct Brick {
    Brick() { occupied.fill(BeliefModel::kUnobserved); }
    std::array<double, kBrickVoxels> occupied;    ///< Probability.
    std::array<ScanNumber, kBrickVoxels> seen{};  ///< When last; 0 if it is not in the map.
    /// No voxel was last seen earlier, or later.
    ScanNumber oldest = std::numeric_limits<ScanNumber>::max(), newest = 0;
  };
  struct Block {
    VoxelIndex at = VoxelIndex::Zero();
    std::array<std::uint64_t, kColumns> known{};  ///< By column.
    std::array<std::uint64_t, kColumns> free{};   ///< As far as known.
    std::array<std::unique_ptr<Brick>, kBricks> bricks;
    std::vector<VoxelIndex> appeared;  ///< In the scan observed last.
  };
  /// Where a voxel stands in its block.
  static std::size_t brick_of(std::size_t column, int height);
  static std::size_t place_of(std::size_t column, int height);
  static VoxelIndex corner_of(std::size_t brick);

  void observe_block(const ScanBlock& seen, const DistanceField& distances, Block& block) const;
  void observe_voxel(std::size_t column, int height, int distance, Block& block) const;
  /// @return whether nothing of the block is left
  bool forget_in(const Eigen::Vector3d& sensor, Block& block);
  void forget_in(const Eigen::Vector3d& sensor, bool is_near, Block& block, std::size_t number);
  template <class IsGone>
  void forget_voxels(Block& block, std::size_t number, IsGone&& is_gone);
  void forget_voxel(Block& block, Brick& brick, const VoxelIndex& place);
  [[nodiscard]] bool is_within(const VoxelIndex& first, const VoxelIndex& sides,
                               const Eigen::Vector3d& sensor) const;

  Lattice lattice_;
  BeliefModel model_;
  double range_;  ///< What is farther from the sensor is forgotten, metres.
  int scans_;     ///< What was not seen for more is forgotten.
  bool offline_;
  ScanNumber now_ = 0;
  CellSet forgotten_free_;
  VoxelMap<std::unique_ptr<Block>> blocks_;
  std::vector<VoxelIndex> appeared_;
  Workspaces<DistanceField> distances_;
  ScanGrid beyond_ = empty_grid();  ///< Of the scan observed last and the one before.
};

}  // namespace raymoval::hmm_mos_method
