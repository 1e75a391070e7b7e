// SPDX-License-Identifier: MIT
#include "methods/removert/map_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace raymoval::removert_method {
namespace {

constexpr int kGroupBits = 3;
constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

VoxelKey group_of(VoxelKey block) {
  const VoxelIndex index = voxel_index(block);
  return voxel_key(index.x() >> kGroupBits, index.y() >> kGroupBits, index.z() >> kGroupBits);
}

/// Blocks of a group are neighbours in this order.
bool comes_first(VoxelKey a, VoxelKey b) {
  const VoxelKey group_a = group_of(a), group_b = group_of(b);
  return group_a != group_b ? group_a < group_b : a < b;
}

/// A slightly enlarged ball, so that rounding leaves no point outside.
Ball ball_around(const Eigen::AlignedBox3d& box) {
  return {box.center(), static_cast<float>(0.5 * box.diagonal().norm() * 1.0001 + 1e-5)};
}

Eigen::AlignedBox3d box_of(const MapPoints& points, const Block& block) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = block.begin; i < block.end; ++i) box.extend(points.position(block, i));
  return box;
}

/// Opens a block like `model` at the end of `points`.
void open_block(MapPoints& points, const Block& model) {
  points.blocks.push_back({model.key, model.centre, points.size(), points.size(), {}});
}

/// Closes the last opened block; an empty block is dropped.
void close_block(MapPoints& points) {
  points.blocks.back().end = points.size();
  if (points.blocks.back().begin == points.size()) points.blocks.pop_back();
}

}  // namespace

void MapPoints::reserve(std::size_t points) {
  for (auto* values : {&x, &y, &z}) values->reserve(points);
  id.reserve(points);
}

void MapPoints::close() {
  groups.clear();
  Eigen::AlignedBox3d group_box;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (b == 0 || group_of(blocks[b].key) != group_of(blocks[b - 1].key)) {
      groups.push_back({b, b, {}});
      group_box.setEmpty();
    }
    const Eigen::AlignedBox3d box = box_of(*this, blocks[b]);
    blocks[b].ball = ball_around(box);
    group_box.extend(box);
    groups.back().end = b + 1;
    groups.back().ball = ball_around(group_box);
  }
}

MapPoints marked_points(const MapPoints& points, const Mask& marks, std::uint8_t mark) {
  MapPoints chosen;
  chosen.reserve(static_cast<std::size_t>(std::count(marks.begin(), marks.end(), mark)));
  for (const Block& block : points.blocks) {
    open_block(chosen, block);
    for (std::size_t i = block.begin; i < block.end; ++i) {
      if (marks[i] != mark) continue;
      chosen.x.push_back(points.x[i]);
      chosen.y.push_back(points.y[i]);
      chosen.z.push_back(points.z[i]);
      chosen.id.push_back(points.id[i]);
    }
    close_block(chosen);
  }
  chosen.close();
  return chosen;
}

CellLattice::Place CellLattice::place_of(const Eigen::Vector3d& world) const {
  const VoxelIndex index = voxel_index(world, inverse_edge_);
  const int mask = (1 << bits_) - 1;
  const int cell =
      ((index.z() & mask) << (2 * bits_)) | ((index.y() & mask) << bits_) | (index.x() & mask);
  return {voxel_key(index.x() >> bits_, index.y() >> bits_, index.z() >> bits_),
          static_cast<std::uint32_t>(cell), index};
}

VoxelIndex CellLattice::cell_index(VoxelKey block, std::uint32_t cell) const {
  const int mask = (1 << bits_) - 1;
  const int packed = static_cast<int>(cell);
  return voxel_index(block) * (1 << bits_) +
         VoxelIndex(packed & mask, (packed >> bits_) & mask, (packed >> (2 * bits_)) & mask);
}

Eigen::Vector3d CellLattice::cell_centre(const VoxelIndex& index) const {
  return (index.cast<double>().array() + 0.5).matrix() * edge_;
}

Eigen::Vector3d CellLattice::block_centre(VoxelKey block) const {
  const double cells = 1 << bits_;
  return (voxel_index(block).cast<double>().array() + 0.5).matrix() * (edge_ * cells);
}

MapBuilder::MapBuilder(const CellLattice& lattice)
    : lattice_(lattice), slot_(lattice.cells_per_block(), kNoSlot) {}

void MapBuilder::add(const std::vector<Eigen::Vector3f>& points, const Pose& T_world_sensor,
                     int threads) {
  std::vector<VoxelKey> keys(points.size());
  std::vector<Entry> entries(points.size());
  parallel_for(threads, points.size(), 8192, [&](std::size_t i) {
    const Eigen::Vector3d world = T_world_sensor * points[i].cast<double>();
    const CellLattice::Place place = lattice_.place_of(world);
    keys[i] = place.block;
    entries[i].id = place.cell;
    entries[i].sum = (world - lattice_.cell_centre(place.index)).cast<float>();
    entries[i].count = 1;
  });
  for (std::size_t i = 0; i < points.size(); ++i) append(keys[i], entries[i]);
}

void MapBuilder::append(VoxelKey key, const Entry& entry) {
  const auto [found, is_new] =
      block_of_.try_emplace(key, static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) blocks_.push_back({key, {}, 0});
  OpenBlock& block = blocks_[found->second];
  block.entries.push_back(entry);
  if (block.entries.size() > block.merged + block.merged / 2 + 32) merge(block);
}

void MapBuilder::merge(OpenBlock& block) {
  std::vector<Entry>& entries = block.entries;
  for (std::size_t i = 0; i < block.merged; ++i) {
    slot_[entries[i].id] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = block.merged; i < entries.size(); ++i) {
    std::uint32_t& slot = slot_[entries[i].id];
    if (slot == kNoSlot) {
      slot = static_cast<std::uint32_t>(block.merged);
      entries[block.merged++] = entries[i];
    } else {
      entries[slot].sum += entries[i].sum;
      entries[slot].count += entries[i].count;
    }
  }
  entries.resize(block.merged);
  for (const Entry& entry : entries) slot_[entry.id] = kNoSlot;
}

void MapBuilder::move_block(OpenBlock& from, MapPoints& to) const {
  Block block;
  block.key = from.key;
  block.centre = lattice_.block_centre(from.key);
  open_block(to, block);
  std::sort(from.entries.begin(), from.entries.end(),
            [](const Entry& a, const Entry& b) { return a.id < b.id; });
  for (const Entry& entry : from.entries) {
    const Eigen::Vector3d cell = lattice_.cell_centre(lattice_.cell_index(from.key, entry.id));
    const Eigen::Vector3d offset =
        cell - block.centre + entry.sum.cast<double>() / static_cast<double>(entry.count);
    to.x.push_back(static_cast<float>(offset.x()));
    to.y.push_back(static_cast<float>(offset.y()));
    to.z.push_back(static_cast<float>(offset.z()));
    to.id.push_back(entry.id);
  }
  close_block(to);
  from.entries = {};
}

MapPoints MapBuilder::finish() {
  for (OpenBlock& block : blocks_) merge(block);
  std::sort(blocks_.begin(), blocks_.end(),
            [](const OpenBlock& a, const OpenBlock& b) { return comes_first(a.key, b.key); });
  std::size_t count = 0;
  for (const OpenBlock& block : blocks_) count += block.entries.size();
  MapPoints points;
  points.reserve(count);
  for (OpenBlock& block : blocks_) move_block(block, points);
  blocks_.clear();
  block_of_.clear();
  points.close();
  return points;
}

}  // namespace raymoval::removert_method
