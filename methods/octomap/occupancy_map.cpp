// SPDX-License-Identifier: MIT
#include "methods/octomap/occupancy_map.h"

#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>

#include "core/parallel.h"

namespace raymoval::octomap_method {
namespace {

using Key = octomap::OcTreeKey;

constexpr std::size_t kBeamsPerTask = 4096;

VoxelKey block_name(const Key& cell) {
  return voxel_key(cell[0] >> 3, cell[1] >> 3, cell[2] >> 3);
}

std::uint64_t bit_of(const Key& cell) {
  return std::uint64_t{1} << ((cell[1] & 7) << 3 | (cell[2] & 7));
}

/// Whether `computeRayKeys` ends within the memory of a `KeyRay`. A beam whose squared length
/// underflows has no direction in float.
bool can_be_traced(const octomap::point3d& beam, const Key& first, const Key& last) {
  int walls = 0;
  for (unsigned axis = 0; axis < 3; ++axis) walls += std::abs(last[axis] - first[axis]);
  constexpr int kMostWalls = 99'900;
  return walls <= kMostWalls && beam.norm_sq() > 1e-24;
}

}  // namespace

/// Marks cells of a scan, on one of several threads. Consecutive cells are mostly in one block.
class OccupancyMap::Marker {
 public:
  explicit Marker(const VoxelMap<Block*>& block_at) : block_at_(block_at) {}

  void mark(const Key& cell, Block::Bits Block::*bits) {
    if (const VoxelKey name = block_name(cell); name != name_) {
      const auto found = block_at_.find(name);
      block_ = found == block_at_.end() ? nullptr : found->second;
      name_ = name;
    }
    const std::size_t x = cell[0] & 7;
    const std::uint64_t bit = bit_of(cell);
    if (block_ == nullptr || (block_->kept[x] & bit) == 0) return;
    const std::atomic_ref<std::uint64_t> word((block_->*bits)[x]);
    if ((word.load(std::memory_order_relaxed) & bit) != 0) return;
    word.fetch_or(bit, std::memory_order_relaxed);
    const std::atomic_ref<bool> is_marked(block_->is_marked);
    if (!is_marked.exchange(true, std::memory_order_relaxed)) marked_.push_back(block_);
  }

  /// The blocks that it changed first.
  [[nodiscard]] const std::vector<Block*>& marked() const { return marked_; }

 private:
  const VoxelMap<Block*>& block_at_;
  VoxelKey name_ = ~VoxelKey{0};
  Block* block_ = nullptr;
  std::vector<Block*> marked_;
};

OccupancyMap::OccupancyMap(const Parameters& parameters)
    : parameters_(&parameters), tree_(parameters.resolution) {
  tree_.setProbHit(parameters.prob_hit);
  tree_.setProbMiss(parameters.prob_miss);
  tree_.setClampingThresMin(parameters.clamp_min);
  tree_.setClampingThresMax(parameters.clamp_max);
  tree_.setOccupancyThres(parameters.occupancy_threshold);
}

std::optional<Key> OccupancyMap::cell_of(const octomap::point3d& point) const {
  // liboctomap casts to int before it checks.
  const double reach = kReach * parameters_->resolution;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (!(std::abs(point(axis)) <= reach)) return std::nullopt;
  }
  Key key;
  if (!tree_.coordToKeyChecked(point, key)) return std::nullopt;
  return key;
}

void OccupancyMap::keep(const Key& cell) {
  Block*& block = block_at_[block_name(cell)];
  if (block == nullptr) {
    block = &blocks_.emplace_back();
    for (unsigned axis = 0; axis < 3; ++axis) block->first[axis] = cell[axis] & ~7;
  }
  block->kept[cell[0] & 7] |= bit_of(cell);
}

void OccupancyMap::insert(const std::vector<octomap::point3d>& points,
                          const std::vector<PointRole>& roles, const octomap::point3d& origin,
                          const RunContext& context) {
  {
    const StageScope timed(context.times, "beams");
    std::mutex mutex;
    parallel_chunks(context.threads, points.size(), kBeamsPerTask,
                    [&](std::size_t begin, std::size_t end) {
                      context.check_cancelled();
                      octomap::KeyRay ray;
                      Marker marker(block_at_);
                      for (std::size_t i = begin; i < end; ++i) {
                        mark_point(points[i], roles[i], origin, ray, marker);
                      }
                      const std::lock_guard lock(mutex);
                      marked_.insert(marked_.end(), marker.marked().begin(), marker.marked().end());
                    });
  }
  const StageScope timed(context.times, "map update");
  update_tree();
}

void OccupancyMap::mark_point(const octomap::point3d& point, PointRole role,
                              const octomap::point3d& origin, octomap::KeyRay& ray,
                              Marker& marker) const {
  auto last = cell_of(point);
  if (!last) return;
  octomap::point3d end = point;
  bool hits = role != PointRole::kGround;
  if (role != PointRole::kNoise) {
    const double maximum_range = parameters_->maximum_range;
    if (maximum_range > 0.0 && (end - origin).norm() > maximum_range) {
      end = origin + (end - origin).normalized() * static_cast<float>(maximum_range);
      last = cell_of(end);
      if (!last) return;
      if (parameters_->cut_end_free && hits) marker.mark(*last, &Block::free);
      hits = false;
    }
    const auto first = cell_of(origin);
    if (first && can_be_traced(end - origin, *first, *last)) {
      tree_.computeRayKeys(origin, end, ray);
      for (const Key& cell : ray) marker.mark(cell, &Block::free);
    }
  }
  if (hits) marker.mark(*last, &Block::hit);
}

void OccupancyMap::update_tree() {
  for (Block* block : marked_) {
    const auto update = [&](std::size_t x, std::uint64_t bits, bool is_hit) {
      for (; bits != 0; bits &= bits - 1) {
        const int bit = std::countr_zero(bits);
        Key cell = block->first;
        cell[0] += static_cast<octomap::key_type>(x);
        cell[1] += static_cast<octomap::key_type>(bit >> 3);
        cell[2] += static_cast<octomap::key_type>(bit & 7);
        tree_.updateNode(cell, is_hit, true);  // Lazy: nothing reads inner nodes.
      }
    };
    for (std::size_t x = 0; x < 8; ++x) {
      const std::uint64_t hit = block->hit[x];
      update(x, parameters_->kth_nonexclusive ? block->free[x] : block->free[x] & ~hit, false);
      update(x, hit, true);
    }
    block->free = block->hit = {};
    block->is_marked = false;
  }
  marked_.clear();
}

}  // namespace raymoval::octomap_method
