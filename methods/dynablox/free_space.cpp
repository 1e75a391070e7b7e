// SPDX-License-Identifier: MIT
#include "methods/dynablox/free_space.h"

#include <algorithm>
#include <cstdlib>

#include "core/parallel.h"

namespace raymoval::dynablox_method {
namespace {

constexpr std::size_t kSweptAtOnce = 8;

/// The blocks around a block and itself, by (dz, dy, dx); null where there is none.
using BlocksBeside = std::array<const Block*, 27>;

std::size_t beside(int dx, int dy, int dz) {
  return static_cast<std::size_t>((dz + 1) * 9 + (dy + 1) * 3 + dx + 1);
}

BlocksBeside blocks_beside(const BlockMap& map, const Block& block) {
  BlocksBeside blocks;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const bool is_self = dx == 0 && dy == 0 && dz == 0;
        blocks[beside(dx, dy, dz)] = is_self ? &block : map.find(block.at + VoxelIndex(dx, dy, dz));
      }
    }
  }
  return blocks;
}

std::uint32_t settled_row(const Block* block, int y, int z) {
  if (block == nullptr) return 0;
  return block->settled[row_of({0, y, z})];
}

/// Which neighbours along x of the voxels of a row count besides those right beside it.
enum class Reach { kRow, kRowAndSides };

/// The settled voxels of a row at (y, z), each of which may be just outside the block: those whose
/// neighbours along x are settled too, if these count.
std::uint32_t eroded_row(const BlocksBeside& blocks, int y, int z, Reach reach) {
  const auto side_of = [](int i) { return i < 0 ? -1 : (i >= kSide ? 1 : 0); };
  const int dy = side_of(y), dz = side_of(z);
  const std::uint32_t row = settled_row(blocks[beside(0, dy, dz)], y, z);
  if (reach == Reach::kRow || row == 0) return row;
  const std::uint32_t lower = settled_row(blocks[beside(-1, dy, dz)], y, z) >> (kSide - 1) & 1;
  const std::uint32_t upper = settled_row(blocks[beside(1, dy, dz)], y, z) & 1;
  return row & (row << 1 | lower) & (row >> 1 | upper << (kSide - 1));
}

/// Of the voxels of a row, those with all neighbours settled. @param axes see `axes_of`
std::uint32_t surrounded(const BlocksBeside& blocks, int y, int z, int axes) {
  std::uint32_t all = eroded_row(blocks, y, z, Reach::kRowAndSides);
  for (int dz = -1; dz <= 1 && all != 0; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      const int differing = std::abs(dy) + std::abs(dz);
      if (differing == 0 || differing > axes) continue;
      const Reach reach = differing < axes ? Reach::kRowAndSides : Reach::kRow;
      all &= eroded_row(blocks, y + dy, z + dz, reach);
    }
  }
  return all;
}

kernels::SweptLayer swept(Layer& layer, Block& block, std::size_t z) {
  const std::size_t first_row = z * kSide;
  return {.distance = layer.distance.data(),
          .weight = layer.weight.data(),
          .last_occupied = layer.last_occupied.data(),
          .occupied_scans = layer.occupied_scans.data(),
          .hit = nullptr,
          .settled = block.settled.data() + first_row,
          .lasting = nullptr};
}

}  // namespace

int axes_of(Neighbours neighbours) {
  return neighbours == Neighbours::kFaces ? 1 : (neighbours == Neighbours::kEdges ? 2 : 3);
}

std::vector<VoxelIndex> steps_to(Neighbours neighbours) {
  std::vector<VoxelIndex> steps;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int differing = std::abs(dx) + std::abs(dy) + std::abs(dz);
        if (differing > 0 && differing <= axes_of(neighbours)) steps.emplace_back(dx, dy, dz);
      }
    }
  }
  return steps;
}

FreeSpace::FreeSpace(const Parameters& parameters)
    : parameters_(parameters), kernels_(kernels::best_kernels()) {}

kernels::Sweep FreeSpace::job(std::int32_t scan) const {
  return {.occupied_below = static_cast<float>(parameters_.occupied_below),
          .scan = scan,
          .temporal_buffer = parameters_.temporal_buffer,
          .burn_in = parameters_.burn_in,
          .frames_to_reset = parameters_.frames_to_reset,
          .resets_free = parameters_.public_reset};
}

void FreeSpace::sweep(const VoxelHits& hits, std::int32_t scan, Block& block,
                      std::vector<VoxelIndex>& lasting) const {
  // The distance of a voxel that was never seen is 0, so that it counts as occupied.
  Occupation& unseen = block.unseen;
  const bool goes_on = unseen.last_occupied >= scan - parameters_.temporal_buffer;
  unseen.scans = goes_on ? static_cast<std::uint16_t>(std::min(unseen.scans + 1, 65535)) : 1;
  unseen.last_occupied = scan;
  const BlockBits* hit = hits.find(block.at);
  BlockBits long_occupied{};
  for (std::size_t z = 0; z < kSide; ++z) {
    if (block.layers[z] == nullptr) continue;
    kernels::SweptLayer layer = swept(*block.layers[z], block, z);
    layer.hit = hit == nullptr ? nullptr : hit->data() + z * kSide;
    layer.lasting = long_occupied.data() + z * kSide;
    kernels_.sweep(job(scan), layer);
  }
  block.settled_at = scan;
  for (int row = 0; row < kLayer; ++row) {
    const auto at = static_cast<std::size_t>(row);
    const unsigned bits = long_occupied[at] & block.ever_free[at];
    for (int x = 0; bits >> x != 0; ++x) {
      if ((bits >> x & 1) == 0) continue;
      lasting.push_back(kSide * block.at + VoxelIndex(x, row % kSide, row / kSide));
    }
  }
}

void FreeSpace::settle(std::int32_t scan, Block& block) const {
  for (std::size_t z = 0; z < kSide; ++z) {
    if (block.layers[z] == nullptr) continue;
    kernels_.settle(job(scan), swept(*block.layers[z], block, z));
  }
  block.settled_at = scan;
}

void FreeSpace::reset(const VoxelIndex& voxel, BlockMap& map) const {
  const auto clear = [&map](const VoxelIndex& at) {
    Block* block = map.find(block_of(at));
    if (block == nullptr) return;
    std::uint16_t& row = block->ever_free[row_of(at)];
    row = static_cast<std::uint16_t>(row & ~bit_of(at));
  };
  clear(voxel);
  for (const VoxelIndex& step : steps_to(parameters_.free_neighbours)) clear(voxel + step);
}

void FreeSpace::add_ever_free(const BlockMap& map, Block& block) const {
  const BlocksBeside blocks = blocks_beside(map, block);
  const int axes = axes_of(parameters_.free_neighbours);
  for (int z = 0; z < kSide; ++z) {
    if (block.layers[static_cast<std::size_t>(z)] == nullptr) continue;
    for (int y = 0; y < kSide; ++y) {
      const std::size_t row = row_of({0, y, z});
      const std::uint32_t wanted = block.settled[row] & ~std::uint32_t{block.ever_free[row]};
      if (wanted == 0) continue;
      const std::uint32_t found = wanted & surrounded(blocks, y, z, axes);
      block.ever_free[row] = static_cast<std::uint16_t>(block.ever_free[row] | found);
    }
  }
}

void FreeSpace::update(const std::vector<Block*>& touched, const VoxelHits& hits, std::int32_t scan,
                       const RunContext& context, BlockMap& map) const {
  const StageScope timed(context.times, "free space");
  std::vector<std::vector<VoxelIndex>> lasting(touched.size());
  parallel_for(context.threads, touched.size(), kSweptAtOnce,
               [&](std::size_t i) { sweep(hits, scan, *touched[i], lasting[i]); });
  // All are found before the first is reset, so that no order of blocks counts.
  for (const std::vector<VoxelIndex>& of_block : lasting) {
    for (const VoxelIndex& voxel : of_block) reset(voxel, map);
  }
  std::vector<Block*> others;
  for (const Block* block : touched) {
    for (const VoxelIndex& step : steps_to(Neighbours::kCorners)) {
      Block* other = map.find(block->at + step);
      if (other == nullptr || other->settled_at == scan) continue;
      other->settled_at = scan;
      others.push_back(other);
    }
  }
  parallel_for(context.threads, others.size(), kSweptAtOnce,
               [&](std::size_t i) { settle(scan, *others[i]); });
  parallel_for(context.threads, touched.size(), kSweptAtOnce,
               [&](std::size_t i) { add_ever_free(map, *touched[i]); });
}

}  // namespace raymoval::dynablox_method
