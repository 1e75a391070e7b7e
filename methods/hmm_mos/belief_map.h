// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/scan/cell_set.h"
#include "methods/common/workspaces.h"
#include "methods/hmm_mos/distances.h"
#include "methods/hmm_mos/scan_voxels.h"

namespace raymoval::hmm_mos_method {

/// The hidden Markov model of one voxel. Of its three states, unobserved has probability 0 after
/// the first observation, so that one number is stored: the probability of occupied.
class BeliefModel {
 public:
  /// Before the first observation: occupied and free are equally likely, as after a step from the
  /// state unobserved.
  static constexpr double kUnobserved = 0.5;
  /// The largest number of squared distances that are distinguished.
  static constexpr int kMostDistances = 254;

  /// @throws ConfigurationError if more than `kMostDistances` must be distinguished
  explicit BeliefModel(const Parameters& parameters);

  /// From this squared distance on, in voxels, all distances are equivalent: after such an
  /// observation the state is free, and occupied is so unlikely that its probability does not
  /// change the next step in double precision.
  [[nodiscard]] int far() const { return static_cast<int>(likelihood_.size()); }

  /// Step 4: the probability of occupied after one more observation.
  /// @param occupied the probability before the observation
  /// @param distance squared, in voxels, to the nearest occupied voxel; not above `far()`
  [[nodiscard]] double after(double occupied, int distance) const {
    if (distance == 0) return 1.0;
    if (distance >= far()) return 0.0;
    const double likelihood = likelihood_[static_cast<std::size_t>(distance)];
    const double stays = likelihood * (transition_ + keep_ * occupied);
    const double goes = (1.0 - likelihood) * (transition_ + keep_ * (1.0 - occupied));
    return stays / (stays + goes);
  }
  [[nodiscard]] bool is_occupied(double occupied) const { return occupied > belief_; }
  [[nodiscard]] bool is_free(double occupied) const { return 1.0 - occupied > belief_; }

 private:
  [[nodiscard]] bool is_far(double likelihood) const;

  double transition_, keep_, belief_;
  std::vector<double> likelihood_;  ///< p_o by squared distance.
};

/// The belief on recently observed voxels around the sensor.
class BeliefMap {
 public:
  explicit BeliefMap(const Parameters& parameters);

  /// Steps 3 and 4 for the observed voxels of a scan.
  /// @param before the previous scan; empty if there is none
  void observe(const ScanVoxels& now, const ScanVoxels& before, const RunContext& context);
  /// The voxels that are occupied in the last observed scan and were free before.
  [[nodiscard]] const std::vector<VoxelIndex>& appeared() const { return appeared_; }
  /// Step 5, after each scan: forgets voxels that are far from the sensor or were not seen for
  /// long.
  /// @param sensor world position, metres
  void forget(const Eigen::Vector3d& sensor);

  /// The voxels of a column with a known state: occupied or free.
  [[nodiscard]] std::uint64_t known(const VoxelIndex& block, std::size_t column) const {
    const Block* found = blocks_.find(block);
    return found == nullptr ? 0 : found->known[column];
  }
  /// Forgets all voxels, after the last scan.
  void forget_all();
  /// The voxels that were free when they were last forgotten; none unless `offline`.
  [[nodiscard]] const CellSet& forgotten_free() const { return forgotten_free_; }
  /// The number of voxels in the map, for tests. The time grows with the map.
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
    std::array<ScanNumber, kBrickVoxels> seen{};  ///< Last scan; 0 if it is not in the map.
    /// Bounds of `seen` over its voxels.
    ScanNumber oldest = std::numeric_limits<ScanNumber>::max(), newest = 0;
  };
  struct Block {
    explicit Block(const VoxelIndex& position) : at(position) {}
    VoxelIndex at;
    std::array<std::uint64_t, kColumns> known{};  ///< By column.
    std::array<std::uint64_t, kColumns> free{};   ///< Of the known voxels.
    std::array<std::unique_ptr<Brick>, kBricks> bricks;
    std::vector<VoxelIndex> appeared;  ///< In the last observed scan.
  };
  /// The position of a voxel in its block.
  static std::size_t brick_of(std::size_t column, int height);
  static std::size_t place_of(std::size_t column, int height);
  static VoxelIndex corner_of(std::size_t brick);

  void observe_block(const ScanBlock& seen, const DistanceField& distances, Block& block) const;
  void observe_voxel(std::size_t column, int height, int distance, Block& block) const;
  template <class IsGone>
  void forget_voxels(Block& block, std::size_t number, IsGone&& is_gone);
  void forget_voxel(Block& block, Brick& brick, const VoxelIndex& place);
  [[nodiscard]] bool is_within(const VoxelIndex& first, const Eigen::Vector3d& sensor) const;

  Lattice lattice_;
  BeliefModel model_;
  double range_;  ///< Voxels farther from the sensor are forgotten, metres.
  int scans_;     ///< Voxels not seen for more scans are forgotten.
  bool offline_;
  ScanNumber now_ = 0;
  CellSet forgotten_free_;
  SparseBlocks<Block> blocks_;
  std::vector<VoxelIndex> appeared_;
  Workspaces<DistanceField> distances_;
  ScanGrid beyond_ = empty_grid();  ///< Of the last two observed scans.
};

}  // namespace raymoval::hmm_mos_method
