// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/raymoval_plus/dense_blocks.h"

namespace raymoval {

enum class Evidence : std::uint8_t { kUndecided = 0, kStatic = 1, kDynamic = 2 };

/// What the scans say of a voxel.
struct VoxelEvidence {
  std::uint16_t free_scans = 0;   ///< Scans that saw through the voxel.
  std::uint16_t agree_scans = 0;  ///< Scans with a return at the voxel.
  /// Scans in a row that saw through it from near by, before the first and since the last scan
  /// that agrees.
  std::uint16_t leading_free = 0, trailing_free = 0;
};

/// The occupied voxels, each with the mean of its points and what the scans say of it. Voxels are
/// numbered in order of their first points; they can be added at any time.
class EvidenceMap {
 public:
  using Blocks = DenseBlocks<std::uint32_t, 2, 2>;  ///< 4 x 4 x 4 voxels.
  static constexpr std::uint32_t kNone = Blocks::kNone;

  explicit EvidenceMap(double voxel_size)
      : size_(voxel_size), inverse_(1.0 / voxel_size), blocks_(kNone) {}

  [[nodiscard]] VoxelIndex index_of(const Eigen::Vector3d& point) const {
    return voxel_index(point, inverse_);
  }
  /// Adds a world point, metres; returns the number of its voxel.
  std::uint32_t add(const Eigen::Vector3d& point, Blocks::Cursor& cursor);

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  /// Number of the voxel that holds a world point, or `kNone`.
  [[nodiscard]] std::uint32_t find(const Eigen::Vector3d& point, Blocks::Cursor& cursor) const {
    return blocks_.get(index_of(point), cursor);
  }
  [[nodiscard]] const VoxelIndex& index(std::size_t voxel) const { return voxels_[voxel].index; }
  /// Mean of the voxel's points so far, world frame, metres.
  [[nodiscard]] Eigen::Vector3d centroid(std::size_t voxel) const;

  /// 64 x 64 columns of voxels. A block belongs to one tile.
  struct Tile {
    Eigen::Vector3d origin;             ///< World frame, metres.
    std::vector<std::uint32_t> voxels;  ///< In order of their first points.
    std::vector<float> places;          ///< x y z of each voxel's mean from the origin, metres.
    std::vector<VoxelEvidence> evidence;
  };
  /// Brings the means in `Tile::places` up to date with what was added.
  void settle();
  /// Tiles that have a part within `range` metres of `center`, seen from above, in a fixed order.
  [[nodiscard]] std::vector<Tile*> tiles_near(const Eigen::Vector3d& center, double range);

  [[nodiscard]] const VoxelEvidence& evidence(std::size_t voxel) const {
    return tiles_[voxels_[voxel].tile].evidence[voxels_[voxel].place];
  }
  [[nodiscard]] VoxelEvidence& evidence(std::size_t voxel) {
    return tiles_[voxels_[voxel].tile].evidence[voxels_[voxel].place];
  }
  /// What the voxel's own evidence amounts to. Threads may set voxels of different blocks.
  [[nodiscard]] Evidence decision(std::size_t voxel) const { return decisions_[slots_[voxel]]; }
  void set_decision(std::size_t voxel, Evidence decision);
  /// What its neighbours made of that.
  [[nodiscard]] Evidence verdict(std::size_t voxel) const { return verdicts_[slots_[voxel]]; }
  void set_verdict(std::size_t voxel, Evidence verdict) { verdicts_[slots_[voxel]] = verdict; }

  [[nodiscard]] const Blocks& blocks() const { return blocks_; }
  [[nodiscard]] std::uint32_t block_of(std::size_t voxel) const {
    return slots_[voxel] / static_cast<std::uint32_t>(Blocks::kCells);
  }
  /// Decisions on a block's cells, in their order; undecided where there is no voxel.
  [[nodiscard]] const Evidence* decisions(std::uint32_t block) const {
    return decisions_.data() + block * Blocks::kCells;
  }
  /// Number of voxels of a block decided dynamic.
  [[nodiscard]] int dynamic_in(std::uint32_t block) const { return dynamic_[block]; }

 private:
  static constexpr int kTileShift = 6;
  void add_voxel(const VoxelIndex& index);
  struct Voxel {
    VoxelIndex index;
    /// Sums of the points' offsets from the lower corner in 1/256 of the edge.
    std::uint32_t x = 0, y = 0, z = 0, count = 0;
    bool is_unsettled = false;
    std::uint32_t tile = 0, place = 0;  ///< Where its mean stands.
  };

  double size_, inverse_;
  Blocks blocks_;
  std::vector<std::uint8_t> dynamic_;  ///< By block.
  std::vector<Voxel> voxels_;
  std::vector<std::uint32_t> slots_;            ///< By voxel: block and cell, ...
  std::vector<Evidence> decisions_, verdicts_;  ///< ... by which these are stored.
  VoxelMap<std::uint32_t> tile_numbers_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> unsettled_;  ///< Voxels.
};

}  // namespace raymoval
