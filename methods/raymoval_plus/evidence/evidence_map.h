// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/raymoval_plus/common/dense_blocks.h"

namespace raymoval::raymoval_plus_method {

/// What a voxel or a point is taken for.
enum class Verdict : std::uint8_t { kUndecided, kStatic, kDynamic };

/// The numbers of scans that say something of a voxel.
struct VoxelEvidence {
  std::uint16_t free_scans = 0;   ///< Scans that saw through the voxel.
  std::uint16_t agree_scans = 0;  ///< Scans with a return at the voxel.
  /// Scans in a row that saw through it from near by, before the first scan that agrees and since
  /// the last one.
  std::uint16_t leading_free = 0, trailing_free = 0;
};

/// Step 2: the occupied voxels. Each has the mean of its points, what the scans say of it (step 3),
/// a decision from that (4) and a verdict, in which its neighbours had a say (5). Voxels are
/// numbered in order of their first points, and can be added at any time.
class EvidenceMap {
 public:
  using Blocks = DenseBlocks<std::uint32_t, 2, 2>;  ///< A block has 4 x 4 x 4 voxels.
  static constexpr std::uint32_t kNone = Blocks::kNone;

  explicit EvidenceMap(double voxel_size)
      : size_(voxel_size), inverse_(1.0 / voxel_size), blocks_(kNone) {}

  [[nodiscard]] VoxelIndex index_of(const Eigen::Vector3d& point) const {
    return voxel_index(point, inverse_);
  }
  /// Adds a world point (metres), and returns the number of its voxel.
  std::uint32_t add(const Eigen::Vector3d& point, Blocks::Cursor& cursor);

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  /// The number of the voxel that holds a world point, or `kNone` if there is none.
  [[nodiscard]] std::uint32_t find(const Eigen::Vector3d& point, Blocks::Cursor& cursor) const {
    return blocks_.get(index_of(point), cursor);
  }
  [[nodiscard]] const VoxelIndex& index(std::size_t voxel) const { return voxels_[voxel].index; }
  /// The mean of the voxel's points so far, world frame, metres.
  [[nodiscard]] Eigen::Vector3d centroid(std::size_t voxel) const;

  /// 64 x 64 columns of voxels. All voxels of a block belong to the same tile.
  struct Tile {
    Eigen::Vector3d origin;             ///< World frame, metres.
    std::vector<std::uint32_t> voxels;  ///< In order of their first points.
    std::vector<float> places;          ///< x y z of each voxel's mean from the origin, metres.
    std::vector<VoxelEvidence> evidence;
  };
  /// Writes the means of the voxels that points were added to into `Tile::places`.
  void update_means();
  /// The tiles of which some part may lie within `range` metres of `center`, seen from above. Their
  /// order is always the same.
  [[nodiscard]] std::vector<Tile*> tiles_near(const Eigen::Vector3d& center, double range);

  [[nodiscard]] const VoxelEvidence& evidence(std::size_t voxel) const {
    return tiles_[voxels_[voxel].tile].evidence[voxels_[voxel].place];
  }
  [[nodiscard]] VoxelEvidence& evidence(std::size_t voxel) {
    return tiles_[voxels_[voxel].tile].evidence[voxels_[voxel].place];
  }
  /// The decision from the voxel's own evidence. Threads may set voxels of different blocks.
  [[nodiscard]] Verdict decision(std::size_t voxel) const { return decisions_[slots_[voxel]]; }
  void set_decision(std::size_t voxel, Verdict decision);
  /// The verdict after its neighbours have voted.
  [[nodiscard]] Verdict verdict(std::size_t voxel) const { return verdicts_[slots_[voxel]]; }
  void set_verdict(std::size_t voxel, Verdict verdict) { verdicts_[slots_[voxel]] = verdict; }

  [[nodiscard]] const Blocks& blocks() const { return blocks_; }
  [[nodiscard]] std::uint32_t block_of(std::size_t voxel) const {
    return slots_[voxel] / static_cast<std::uint32_t>(Blocks::kCells);
  }
  /// The decisions on a block's cells, in their order. A cell without a voxel is undecided.
  [[nodiscard]] const Verdict* decisions(std::uint32_t block) const {
    return decisions_.data() + block * Blocks::kCells;
  }
  /// How many voxels of a block are decided to be dynamic.
  [[nodiscard]] int dynamic_in(std::uint32_t block) const { return dynamic_[block]; }

 private:
  /// A tile has 2^6 columns a side: 12.8 m at voxels of 0.2 m, which is little beside the range
  /// that is asked about, so that few voxels beyond it are asked, and enough for one task of a
  /// thread.
  static constexpr int kTileShift = 6;
  void add_voxel(const VoxelIndex& index);
  struct Voxel {
    VoxelIndex index;
    /// Sums of the points' offsets from the lower corner, in parts of the edge (`kParts`).
    std::uint32_t x = 0, y = 0, z = 0, count = 0;
    bool mean_changed = false;
    std::uint32_t tile = 0, place = 0;  ///< Where its mean and its evidence are.
  };

  double size_, inverse_;
  Blocks blocks_;
  std::vector<std::uint8_t> dynamic_;  ///< By block: see `dynamic_in`.
  std::vector<Voxel> voxels_;
  std::vector<std::uint32_t> slots_;           ///< By voxel: block and cell, ...
  std::vector<Verdict> decisions_, verdicts_;  ///< ... by which these are stored.
  VoxelMap<std::uint32_t> tile_numbers_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> changed_;  ///< Voxels whose mean changed.
};

}  // namespace raymoval::raymoval_plus_method
