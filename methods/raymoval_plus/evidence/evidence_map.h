// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/common/dense_blocks.h"
#include "methods/raymoval_plus/common/scan_cells.h"
#include "methods/raymoval_plus/evidence/beam_image.h"

namespace raymoval::raymoval_plus_method {

/// What a voxel or a point is taken for.
enum class Verdict : std::uint8_t { kUndecided, kStatic, kDynamic };

/// What the scans say of a voxel. A scan hits it if a beam ends there; it passes if beams cross the
/// voxel and end well behind it, and none hits it.
struct VoxelEvidence {
  static constexpr std::size_t kPasses = 4;
  std::uint16_t hits = 0;  ///< Scans that hit the voxel.
  /// Scans that passed before the first hit, and after the last one.
  std::uint16_t passes_before = 0, passes_after = 0;
  /// Scans of which the beams around the voxel end behind it, but none crosses it, likewise.
  std::uint16_t open_before = 0, open_after = 0;
  std::uint32_t first_hit = 0, last_hit = 0;  ///< Scan numbers, if any hit it.
  /// The numbers of the first scans that passed before the first hit, and of the last ones that
  /// passed after the last hit; of the latter, pass number n is at n % kPasses.
  std::array<std::uint32_t, kPasses> first_passes{}, last_passes{};
  /// Scans that passed before or after the thing at the voxel was there, at most kPasses; see
  /// `find_passes_outside`.
  float passes_outside = 0.0F;
};

/// Step 2: the occupied voxels. Each has the mean of its points, what the scans say of it (step 3),
/// a decision from that (4) and a verdict, in which its neighbours had a say (5). Voxels are
/// numbered in order of their first points, and can be added at any time.
class EvidenceMap {
 public:
  using Blocks = DenseBlocks<std::uint32_t, 2, 2>;  ///< A block has 4 x 4 x 4 voxels.
  static constexpr std::uint32_t kNone = Blocks::kNone;

  /// @param voxel_size metres
  /// @param knows_planes whether beams that end just behind the plane of a voxel's points count
  explicit EvidenceMap(double voxel_size, bool knows_planes = true)
      : size_(voxel_size),
        inverse_(1.0 / voxel_size),
        knows_planes_(knows_planes),
        blocks_(kNone) {}

  /// Finds the cells of a scan's points, and where the points are in them.
  void find_cells_of(const Scan& scan, int threads, ScanCells& cells) const {
    find_cells(scan, Eigen::Vector3d::Constant(inverse_), BesideCells::kParts, threads, cells);
  }

  /// Adds a point, and returns the number of its voxel.
  /// @param parts where the point is in its cell, see `ScanCells`
  std::uint32_t add(const VoxelIndex& cell, std::uint32_t parts, Blocks::Cursor& cursor) {
    const std::uint32_t voxel = make_voxel(cell, make_slot(cell, cursor));
    add_point(voxel, parts);
    return voxel;
  }
  /// `add` in three steps. Taking many points through one step before the next lets their memory
  /// come in meanwhile (`expect_slot`, `expect_sums`).
  [[nodiscard]] std::size_t make_slot(const VoxelIndex& cell, Blocks::Cursor& cursor) {
    return blocks_.make_slot(cell, cursor);
  }
  [[nodiscard]] std::uint32_t make_voxel(const VoxelIndex& cell, std::size_t slot) {
    std::uint32_t& number = blocks_.at(slot);
    if (number == kNone) number = add_voxel(cell, static_cast<std::uint32_t>(slot));
    return number;
  }
  void add_point(std::uint32_t voxel, std::uint32_t parts);
  /// Remembers the range from which a point of the voxel was seen, metres.
  void see_from(std::uint32_t voxel, float range) {
    sums_[voxel].nearest = std::min(sums_[voxel].nearest, range);
  }
  /// Adds a place that may be outside of the voxel. @param offset from a point, metres
  void add_beside(std::uint32_t voxel, std::uint32_t parts, const Eigen::Vector3f& offset);
  void add_sample(std::uint32_t voxel, int x, int y, int z);
  void expect_slot(std::size_t slot) const {
    __builtin_prefetch(&blocks_.at(slot));
    if (slot < verdicts_.size()) __builtin_prefetch(&verdicts_[slot]);
  }
  void expect_sums(std::uint32_t voxel) const { __builtin_prefetch(&sums_[voxel]); }

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  [[nodiscard]] double voxel_size() const { return size_; }  ///< Metres.
  /// The place of a cell among those of all blocks, or `Blocks::kNoSlot`.
  [[nodiscard]] std::size_t find_slot(const VoxelIndex& cell, Blocks::Cursor& cursor) const {
    return blocks_.slot(cell, cursor);
  }
  /// The number of the voxel in a slot, or `kNone`.
  [[nodiscard]] std::uint32_t voxel_in(std::size_t slot) const { return blocks_.at(slot); }
  /// The verdict on the voxel in a slot.
  [[nodiscard]] Verdict verdict_in(std::size_t slot) const { return verdicts_[slot]; }
  [[nodiscard]] const VoxelIndex& index(std::size_t voxel) const { return voxels_[voxel].index; }
  /// The mean of the voxel's points so far, world frame, metres.
  [[nodiscard]] Eigen::Vector3d centroid(std::size_t voxel) const;
  /// The distribution of the voxel's points so far.
  [[nodiscard]] VoxelShape shape(std::size_t voxel) const;
  /// How far one of the voxel's points lies above that mean, metres.
  /// @param parts where the point is in its cell, see `ScanCells`
  [[nodiscard]] double above_mean(std::size_t voxel, std::uint32_t parts) const;

  /// 64 x 64 columns of voxels. All voxels of a block belong to the same tile.
  struct Tile {
    Eigen::Vector3d origin;             ///< World frame, metres.
    std::vector<std::uint32_t> voxels;  ///< In order of their first points.
    std::vector<float> places;          ///< x y z of each voxel's mean from the origin, metres.
    std::vector<VoxelShape> shapes;     ///< Of each voxel's points.
  };
  /// Writes the means of the voxels that points were added to into `Tile::places`, and the spans.
  void update_means();
  /// The numbers of the tiles of which some part may lie within `range` metres of `center`, seen
  /// from above, ascending.
  [[nodiscard]] std::vector<std::uint32_t> tiles_near(const Eigen::Vector3d& center,
                                                      double range) const;
  [[nodiscard]] Tile& tile(std::uint32_t number) { return tiles_[number]; }

  [[nodiscard]] const VoxelEvidence& evidence(std::size_t voxel) const { return evidence_[voxel]; }
  [[nodiscard]] VoxelEvidence& evidence(std::size_t voxel) { return evidence_[voxel]; }
  /// The decision from the voxel's own evidence. Threads may set voxels of different blocks.
  [[nodiscard]] Verdict decision(std::size_t voxel) const { return decisions_[slot(voxel)]; }
  void set_decision(std::size_t voxel, Verdict decision);
  /// The verdict after its neighbours have voted.
  [[nodiscard]] Verdict verdict(std::size_t voxel) const { return verdicts_[slot(voxel)]; }
  void set_verdict_in(std::size_t slot, Verdict verdict) { verdicts_[slot] = verdict; }

  [[nodiscard]] const Blocks& blocks() const { return blocks_; }
  /// Which cells of a block have a voxel: bit i for cell i.
  [[nodiscard]] std::uint64_t occupied(std::uint32_t block) const { return occupied_[block]; }
  [[nodiscard]] std::uint32_t block_of(std::size_t voxel) const {
    return slot(voxel) / static_cast<std::uint32_t>(Blocks::kCells);
  }
  /// The decisions on a block's cells, in their order. A cell without a voxel is undecided.
  [[nodiscard]] const Verdict* decisions(std::uint32_t block) const {
    return decisions_.data() + block * Blocks::kCells;
  }
  /// How many voxels of a block are decided to be dynamic.
  [[nodiscard]] int dynamic_in(std::uint32_t block) const { return dynamic_[block]; }
  /// Finds anew which blocks have a dynamic voxel in a block at most `reach` blocks away.
  void update_surroundings(int reach);
  /// Whether that was so at the last `update_surroundings`.
  [[nodiscard]] bool is_near_dynamic(std::uint32_t block) const {
    return dynamic_around_[block] > 0;
  }
  /// Makes the verdicts on a block's voxels its decisions.
  void take_decisions(std::uint32_t block);

 private:
  /// A tile has 2^6 columns a side: 12.8 m at voxels of 0.2 m, which is little beside the range
  /// that is asked about, so that few voxels beyond it are asked, and enough for one task of a
  /// thread.
  static constexpr int kTileShift = 6;
  std::uint32_t add_voxel(const VoxelIndex& index, std::uint32_t slot);
  /// Sums of a voxel's points: offsets from the lower corner, in parts of the edge.
  struct Sums {
    float nearest = 1e9F;
    std::int32_t x = 0, y = 0, z = 0, count = 0;
    std::int64_t xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  ///< Of their products.
  };
  struct Voxel {
    VoxelIndex index;
    std::uint32_t slot;         ///< Block and cell, by which decisions and verdicts are stored.
    std::uint32_t tile, place;  ///< Where its mean and its evidence are.
  };
  [[nodiscard]] std::uint32_t slot(std::size_t voxel) const { return voxels_[voxel].slot; }
  [[nodiscard]] VoxelIndex tile_at(const Eigen::Vector3d& place) const;

  double size_, inverse_;
  bool knows_planes_;
  Blocks blocks_;
  static_assert(Blocks::kCells == 64);
  std::vector<std::uint64_t> occupied_;  ///< By block, see `occupied`.
  std::vector<std::uint8_t> dynamic_;    ///< By block: see `dynamic_in`.
  /// By block: 1 if a voxel of it is dynamic, and whether it was at the last `update_surroundings`.
  std::vector<std::uint8_t> is_dynamic_, was_dynamic_;
  std::vector<std::uint16_t> dynamic_around_;  ///< By block: how many around it were dynamic then.
  int reach_ = -1;                             ///< Of the last `update_surroundings`.
  std::vector<Verdict> decisions_, verdicts_;  ///< By slot.
  std::vector<Voxel> voxels_;
  std::vector<VoxelEvidence> evidence_;
  std::vector<Sums> sums_;
  VoxelMap<std::uint32_t> tile_numbers_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> changed_;      ///< Voxels whose mean changed, ...
  std::vector<std::uint8_t> mean_changed_;  ///< ... which this says of each voxel.
};

/// Calls `visit(voxel, cell)` for each voxel of a block; `cell` is its place in the block.
template <class Visit>
void for_voxels(const EvidenceMap& map, std::uint32_t block, Visit&& visit) {
  const std::uint32_t* const cells = map.blocks().cells(block);
  for (std::uint64_t left = map.occupied(block); left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    visit(cells[i], i);
  }
}

}  // namespace raymoval::raymoval_plus_method
