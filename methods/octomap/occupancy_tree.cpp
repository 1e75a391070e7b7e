// SPDX-License-Identifier: MIT
#include "methods/octomap/occupancy_tree.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/error.h"

namespace raymoval::octomap_method {
namespace {

using Node = OccupancyTree::Node;

/// Number of `name`'s child of depth `depth` below its parent; `name` names a node of depth 13.
unsigned child_number(std::uint64_t name, int depth) {
  return static_cast<unsigned>(name >> 3 * (13 - depth)) & 7U;
}

/// Changes the nodes below and at a block's. The cells below a node come as bits in Morton order: 8
/// words for a block, a word for its children, a byte for theirs, one bit for a leaf.
class BlockUpdate {
 public:
  BlockUpdate(octomap::OcTree& tree, bool merge) : tree_(tree), merge_(merge) {}

  /// Whether a node of this value would change if some of its cells were missed or hit.
  [[nodiscard]] bool would_change(float value, bool missed, bool hit) const {
    return (missed && can_change(value, tree_.getProbMissLog())) ||
           (hit && can_change(value, tree_.getProbHitLog()));
  }

  /// @param created whether the node was made just now and stands for nothing yet
  template <class Bits>
  void update(Node* node, bool created, const Bits& free, const Bits& occupied) {
    if (!tree_.nodeHasChildren(node)) {
      if (is_uniform(free) && is_uniform(occupied)) return update_all(node, free, occupied);
      if (!created) {
        if (!would_change(node->getLogOdds(), any(free), any(occupied))) return;
        tree_.expandNode(node);
      }
    }
    for (unsigned k = 0; k < 8; ++k) {
      const auto free_below = part(free, k), occupied_below = part(occupied, k);
      if (!any(free_below) && !any(occupied_below)) continue;
      const bool missing = !tree_.nodeChildExists(node, k);
      Node* child = missing ? tree_.createNodeChild(node, k) : tree_.getNodeChild(node, k);
      update_child(child, missing, free_below, occupied_below);
    }
    close(node);
  }

  /// Does what liboctomap does on its way back up: it merges equal leaves, else it takes their
  /// maximum.
  void close(Node* node) {
    if (merge_ && !tree_.pruneNode(node)) node->updateOccupancyChildren();
  }

 private:
  using Block = std::array<std::uint64_t, 8>;

  static bool any(const Block& bits) {
    return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
  }
  static bool any(std::uint64_t bits) { return bits != 0; }
  static bool is_uniform(const Block& bits) {
    return is_uniform(bits[0]) && std::all_of(bits.begin(), bits.end(),
                                              [&](std::uint64_t word) { return word == bits[0]; });
  }
  template <class Word>
  static bool is_uniform(Word bits) {
    return bits == 0 || bits == std::numeric_limits<Word>::max();
  }
  static std::uint64_t part(const Block& bits, unsigned k) { return bits[k]; }
  static std::uint8_t part(std::uint64_t bits, unsigned k) {
    return static_cast<std::uint8_t>(bits >> 8 * k);
  }
  static bool part(std::uint8_t bits, unsigned k) { return (bits >> k & 1) != 0; }

  template <class Bits>
  void update_child(Node* child, bool created, const Bits& free, const Bits& occupied) {
    update(child, created, free, occupied);
  }
  void update_child(Node* leaf, bool, bool free, bool occupied) {
    update_all(leaf, free, occupied);
  }

  template <class Bits>
  void update_all(Node* node, const Bits& free, const Bits& occupied) {
    if (any(free)) add(node, tree_.getProbMissLog());
    if (any(occupied)) add(node, tree_.getProbHitLog());
  }
  void add(Node* node, float log_odds) {
    if (can_change(node->getLogOdds(), log_odds)) tree_.updateNodeLogOdds(node, log_odds);
  }
  /// The test by which liboctomap leaves `updateNode` early.
  [[nodiscard]] bool can_change(float value, float log_odds) const {
    return !((log_odds >= 0.0F && value >= tree_.getClampingThresMaxLog()) ||
             (log_odds <= 0.0F && value <= tree_.getClampingThresMinLog()));
  }

  octomap::OcTree& tree_;
  bool merge_;
};

bool any_bit(const std::array<std::uint64_t, 8>& words) {
  return std::any_of(words.begin(), words.end(), [](std::uint64_t word) { return word != 0; });
}

/// Takes out of `cells` what is not among the occupied cells of `wanted`. @return whether any stay
bool keep_wanted(CellBlock& cells, const CellBlock* wanted) {
  if (wanted == nullptr) return false;
  for (std::size_t word = 0; word < 8; ++word) {
    cells.free[word] &= wanted->occupied[word];
    cells.occupied[word] &= wanted->occupied[word];
  }
  return any_bit(cells.free) || any_bit(cells.occupied);
}

/// Key of some cell of `block`, whose first word with a bit set is looked for.
octomap::OcTreeKey touched_key(std::uint64_t name, const CellBlock& cells) {
  for (std::size_t word = 0; word < 8; ++word) {
    const std::uint64_t bits = cells.free[word] | cells.occupied[word];
    if (bits == 0) continue;
    const CellCode code =
        name << kBlockBits | word << 6 | static_cast<std::uint64_t>(std::countr_zero(bits));
    return {gather_bits(code), gather_bits(code >> 1), gather_bits(code >> 2)};
  }
  throw InternalError("octomap: a block without a cell");
}

}  // namespace

OccupancyTree::OccupancyTree(const Parameters& parameters)
    : tree_(parameters.resolution),
      exclusive_(!parameters.kth_nonexclusive),
      merge_(!parameters.lazy_eval) {
  tree_.setProbHit(parameters.prob_hit);
  tree_.setProbMiss(parameters.prob_miss);
  tree_.setClampingThresMin(parameters.clamp_min);
  tree_.setClampingThresMax(parameters.clamp_max);
  tree_.setOccupancyThres(parameters.occupancy_threshold);
}

void OccupancyTree::sort_blocks(const std::vector<CellBlocks>& parts) {
  sorted_.clear();
  for (const CellBlocks& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      sorted_.push_back({part.name(i), &part.content(i)});
    }
  }
  std::sort(sorted_.begin(), sorted_.end(),
            [](const NamedBlock& a, const NamedBlock& b) { return a.name < b.name; });
}

void OccupancyTree::update(const std::vector<CellBlocks>& parts, const CellBlocks* wanted) {
  sort_blocks(parts);
  path_depth_ = -1;
  for (std::size_t i = 0; i < sorted_.size();) {
    const std::uint64_t name = sorted_[i].name;
    CellBlock merged;
    for (; i < sorted_.size() && sorted_[i].name == name; ++i) {
      for (std::size_t word = 0; word < 8; ++word) {
        merged.free[word] |= sorted_[i].cells->free[word];
        merged.occupied[word] |= sorted_[i].cells->occupied[word];
      }
    }
    if (wanted != nullptr && !keep_wanted(merged, wanted->find(name))) continue;
    for (std::size_t word = 0; exclusive_ && word < 8; ++word) {
      merged.free[word] &= ~merged.occupied[word];
    }
    update_block(name, merged);
  }
  leave_down_to(-1);
}

void OccupancyTree::update_block(std::uint64_t name, const CellBlock& cells) {
  if (path_depth_ < 0) {
    // An unseen leaf stands at log-odds 0, whatever it is made by; this one is about to be updated.
    if (tree_.getRoot() == nullptr) tree_.setNodeValue(touched_key(name, cells), 0.0F, true);
    path_[0] = tree_.getRoot();
    path_depth_ = 0;
  } else {
    const auto differing = static_cast<int>(std::bit_width(name ^ path_name_));
    leave_down_to(std::min(path_depth_, kBlockDepth - (differing + 2) / 3));
  }
  path_name_ = name;
  bool created = false;
  if (!descend(name, cells, created)) return;
  BlockUpdate(tree_, merge_).update(path_[kBlockDepth], created, cells.free, cells.occupied);
}

bool OccupancyTree::descend(std::uint64_t name, const CellBlock& cells, bool& created) {
  while (path_depth_ < kBlockDepth) {
    Node* node = path_[static_cast<std::size_t>(path_depth_)];
    if (!created && !tree_.nodeHasChildren(node)) {
      // Eight leaves were merged here, or more.
      const bool changes =
          BlockUpdate(tree_, merge_)
              .would_change(node->getLogOdds(), any_bit(cells.free), any_bit(cells.occupied));
      if (!changes) return false;
      tree_.expandNode(node);
    }
    const unsigned child = child_number(name, path_depth_ + 1);
    created = !tree_.nodeChildExists(node, child);
    ++path_depth_;
    path_[static_cast<std::size_t>(path_depth_)] =
        created ? tree_.createNodeChild(node, child) : tree_.getNodeChild(node, child);
  }
  return true;
}

void OccupancyTree::leave_down_to(int depth) {
  for (; path_depth_ > depth; --path_depth_) {
    Node* node = path_[static_cast<std::size_t>(path_depth_)];
    // A block closes itself.
    if (path_depth_ < kBlockDepth && tree_.nodeHasChildren(node)) {
      BlockUpdate(tree_, merge_).close(node);
    }
  }
}

const octomap::OcTreeNode* TreeReader::find(CellCode cell) {
  const auto below = [this](const octomap::OcTreeNode* node, unsigned child) {
    return tree_.nodeChildExists(node, child) ? tree_.getNodeChild(node, child) : nullptr;
  };
  if (cell >> kBlockBits != block_) {
    block_ = cell >> kBlockBits;
    node_ = tree_.getRoot();
    for (int depth = 1; depth <= 13 && node_ != nullptr && tree_.nodeHasChildren(node_); ++depth) {
      node_ = below(node_, child_number(block_, depth));
    }
  }
  const octomap::OcTreeNode* node = node_;
  for (int depth = 14; depth <= 16 && node != nullptr && tree_.nodeHasChildren(node); ++depth) {
    node = below(node, static_cast<unsigned>(cell >> 3 * (16 - depth)) & 7U);
  }
  return node;
}

}  // namespace raymoval::octomap_method
