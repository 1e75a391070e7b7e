// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/OcTree.h>

#include <array>
#include <utility>
#include <vector>

#include "methods/octomap/cell_blocks.h"
#include "methods/octomap/parameters.h"

namespace raymoval::octomap_method {

/// liboctomap's tree, updated a scan at a time. Where `OcTree::insertPointCloud` goes from the root
/// to a leaf and back for each cell, this goes through the touched part of the tree once per scan,
/// in Morton order. Node for node the tree is the same: a cell's value depends on its own misses
/// and hits only, and what can be merged is merged.
class OccupancyTree {
 public:
  using Node = octomap::OcTreeNode;

  explicit OccupancyTree(const Parameters& parameters);

  [[nodiscard]] const octomap::OcTree& tree() const { return tree_; }

  /// Lowers the free cells and raises the occupied ones, each once. A cell that is both is raised
  /// only, or lowered and then raised if `kth_nonexclusive`.
  /// @param wanted if given, only its occupied cells are put in; no cell depends on another
  void update(const std::vector<CellBlocks>& parts, const CellBlocks* wanted = nullptr);

 private:
  static constexpr int kBlockDepth = 13;  ///< A node of this depth holds 8 x 8 x 8 leaves.

  void sort_blocks(const std::vector<CellBlocks>& parts);
  void update_block(std::uint64_t name, const CellBlock& cells);
  bool descend(std::uint64_t name, const CellBlock& cells, bool& created);
  void leave_down_to(int depth);

  octomap::OcTree tree_;
  bool exclusive_, merge_;
  struct NamedBlock {
    std::uint64_t name;
    const CellBlock* cells;
  };
  std::vector<NamedBlock> sorted_;
  /// Nodes from the root to the block that was updated last, and how far they go.
  std::array<Node*, kBlockDepth + 1> path_{};
  int path_depth_ = 0;
  std::uint64_t path_name_ = 0;
};

/// Answers for cells from a tree that nobody changes. Keeps the node of the last cell's block:
/// points that follow each other in a scan are mostly near each other.
class TreeReader {
 public:
  explicit TreeReader(const octomap::OcTree& tree) : tree_(tree) {}
  /// The node that answers for `cell`; null where the map knows nothing. The same node as
  /// `OcTree::search` gives.
  const octomap::OcTreeNode* find(CellCode cell);

 private:
  const octomap::OcTree& tree_;
  std::uint64_t block_ = ~std::uint64_t{0};
  const octomap::OcTreeNode* node_ = nullptr;
};

}  // namespace raymoval::octomap_method
