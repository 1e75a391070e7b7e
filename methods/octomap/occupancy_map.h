// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "core/scan/voxel_key.h"
#include "methods/octomap/octomap.h"
#include "methods/remover.h"

namespace raymoval::octomap_method {

/// The effect of a point of a scan on the map.
enum class PointRole : std::uint8_t {
  kSurface,  ///< Its cell is hit, and its beam is free.
  kGround,   ///< Its beam is free; its cell is not hit.
  kNoise,    ///< Its cell is hit, and it has no beam.
};

/// liboctomap's tree, restricted to the kept cells. Cells are independent, and most of a map is
/// free space without points. `computeRayKeys` gives the cells of a beam, and `updateNode` the
/// log-odds of a cell.
class OccupancyMap {
 public:
  static constexpr int kReach = 32768;  ///< Leaves from the tree's centre to its edge.

  explicit OccupancyMap(const Parameters& parameters);

  /// The cell that holds `point`, in the tree's frame, metres. No value beyond `kReach`.
  [[nodiscard]] std::optional<octomap::OcTreeKey> cell_of(const octomap::point3d& point) const;

  /// Adds a cell to the kept cells. Must be called before `insert`.
  void keep(const octomap::OcTreeKey& cell);

  /// Inserts a scan like `insertPointCloud`: a kept cell with a hit is raised once, any other kept
  /// cell that a beam crosses is lowered once.
  /// @param points end points in the tree's frame, metres
  /// @param roles one per point
  /// @param origin of the beams, in the same frame
  /// @throws Cancelled
  void insert(const std::vector<octomap::point3d>& points, const std::vector<PointRole>& roles,
              const octomap::point3d& origin, const RunContext& context);

  [[nodiscard]] const octomap::OcTree& tree() const { return tree_; }

 private:
  /// 8 x 8 x 8 cells: a word for each x, a byte for each y, a bit for each z.
  struct Block {
    using Bits = std::array<std::uint64_t, 8>;
    octomap::OcTreeKey first;  ///< The lowest cell.
    Bits kept{}, free{}, hit{};
    bool is_marked = false;  ///< `free` or `hit` has a bit.
  };
  class Marker;

  void mark_point(const octomap::point3d& point, PointRole role, const octomap::point3d& origin,
                  octomap::KeyRay& ray, Marker& marker) const;
  void update_tree();

  const Parameters* parameters_;
  octomap::OcTree tree_;
  std::deque<Block> blocks_;
  VoxelMap<Block*> block_at_;
  std::vector<Block*> marked_;  ///< Blocks that the current scan changes.
};

}  // namespace raymoval::octomap_method
