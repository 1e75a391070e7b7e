// SPDX-License-Identifier: MIT
#include "methods/dynablox/field.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"

namespace raymoval::dynablox_method {
namespace {

constexpr std::size_t kSweptAtOnce = 8;

/// A block and the blocks around it, by (dz, dy, dx); null where there is none.
using BlocksBeside = std::array<const Block*, 27>;

/// The settled voxels of the row at (y, z) whose neighbours along x are settled too. y and z may be
/// one voxel outside the block.
std::uint32_t eroded_row(const BlocksBeside& blocks, int y, int z) {
  const auto side_of = [](int i) { return i < 0 ? 0U : (i >= kSide ? 2U : 1U); };
  const std::size_t middle = side_of(z) * 9 + side_of(y) * 3 + 1;
  const auto settled = [&](std::size_t block) -> std::uint32_t {
    return blocks[block] == nullptr ? 0 : blocks[block]->settled[row_of({0, y, z})];
  };
  const std::uint32_t row = settled(middle);
  if (row == 0) return row;
  const std::uint32_t lower = settled(middle - 1) >> (kSide - 1) & 1;
  const std::uint32_t upper = settled(middle + 1) & 1;
  return row & (row << 1 | lower) & (row >> 1 | upper << (kSide - 1));
}

/// The voxels of a row whose 26 neighbours are settled.
std::uint32_t surrounded(const BlocksBeside& blocks, int y, int z) {
  std::uint32_t all = ~std::uint32_t{0};
  for (int i = 0; i < 9 && all != 0; ++i) all &= eroded_row(blocks, y + i % 3 - 1, z + i / 3 - 1);
  return all;
}

}  // namespace

std::vector<VoxelIndex> FreeSpace::sweep(const BlockBits* hit, bool is_touched, std::int32_t scan,
                                         Block& block) const {
  const kernels::Sweep job{.occupied_below = static_cast<float>(parameters_.occupied_below),
                           .scan = scan,
                           .temporal_buffer = parameters_.temporal_buffer,
                           .burn_in = parameters_.burn_in,
                           .frames_to_reset = parameters_.frames_to_reset};
  if (is_touched) {
    // The distance of a voxel that was never seen is 0, so that it counts as occupied.
    const bool goes_on = block.unseen_last_occupied >= scan - parameters_.temporal_buffer;
    const int scans = goes_on ? block.unseen_occupied_scans + 1 : 1;
    block.unseen_occupied_scans = static_cast<std::uint16_t>(std::min(scans, 65535));
    block.unseen_last_occupied = scan;
  }
  BlockBits lasting{};
  for (std::size_t z = 0; z < kSide; ++z) {
    Layer* const layer = block.layers[z].get();
    if (layer == nullptr) continue;
    const std::size_t row = z * kSide;
    const kernels::SweptLayer swept{.distance = layer->distance.data(),
                                    .weight = layer->weight.data(),
                                    .last_occupied = layer->last_occupied.data(),
                                    .occupied_scans = layer->occupied_scans.data(),
                                    .hit = hit == nullptr ? nullptr : hit->data() + row,
                                    .settled = block.settled.data() + row,
                                    .lasting = lasting.data() + row};
    (is_touched ? kernels_.sweep : kernels_.settle)(job, swept);
  }
  block.settled_at = scan;
  std::vector<VoxelIndex> reset;
  for (int row = 0; row < kLayer; ++row) {
    const auto at = static_cast<std::size_t>(row);
    const unsigned bits = lasting[at] & block.ever_free[at];
    for (int x = 0; bits >> x != 0; ++x) {
      if ((bits >> x & 1) == 0) continue;
      reset.push_back(kSide * block.at + VoxelIndex(x, row % kSide, row / kSide));
    }
  }
  return reset;
}

void FreeSpace::add_ever_free(const BlockMap& map, Block& block) const {
  BlocksBeside blocks;
  std::size_t next = 0;
  for_each_around(block.at, 1, [&](const VoxelIndex& at) { blocks[next++] = map.find(at); });
  for (int z = 0; z < kSide; ++z) {
    if (block.layers[static_cast<std::size_t>(z)] == nullptr) continue;
    for (int y = 0; y < kSide; ++y) {
      const std::size_t row = row_of({0, y, z});
      const std::uint32_t wanted = block.settled[row] & ~std::uint32_t{block.ever_free[row]};
      if (wanted == 0) continue;
      const std::uint32_t found = wanted & surrounded(blocks, y, z);
      block.ever_free[row] = static_cast<std::uint16_t>(block.ever_free[row] | found);
    }
  }
}

void FreeSpace::update(const std::vector<Block*>& touched, const SparseBlocks<BlockBits>& hits,
                       std::int32_t scan, const RunContext& context, BlockMap& map) const {
  const StageScope timed(context.times, "free space");
  std::vector<std::vector<VoxelIndex>> lasting(touched.size());
  parallel_for(context.threads, touched.size(), kSweptAtOnce, [&](std::size_t i) {
    lasting[i] = sweep(hits.find(touched[i]->at), true, scan, *touched[i]);
  });
  // All are found before the first is reset, so that the order of blocks has no effect.
  const auto reset = [&map](const VoxelIndex& voxel) {
    Block* block = map.find(block_of(voxel));
    if (block == nullptr) return;
    std::uint16_t& row = block->ever_free[row_of(voxel)];
    row = static_cast<std::uint16_t>(row & ~bit_of(voxel));
  };
  for (const std::vector<VoxelIndex>& of_block : lasting) {
    for (const VoxelIndex& voxel : of_block) for_each_around(voxel, 1, reset);
  }
  std::vector<Block*> others;
  for (const Block* block : touched) {
    for_each_around(block->at, 1, [&](const VoxelIndex& at) {
      Block* other = map.find(at);
      if (other == nullptr || other->settled_at == scan) return;
      other->settled_at = scan;
      others.push_back(other);
    });
  }
  parallel_for(context.threads, others.size(), kSweptAtOnce,
               [&](std::size_t i) { sweep(nullptr, false, scan, *others[i]); });
  parallel_for(context.threads, touched.size(), kSweptAtOnce,
               [&](std::size_t i) { add_ever_free(map, *touched[i]); });
}

}  // namespace raymoval::dynablox_method
