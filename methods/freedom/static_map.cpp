// SPDX-License-Identifier: MIT
#include "methods/freedom/maps.h"

#include <algorithm>
#include <bit>

namespace raymoval::freedom_method {
namespace {

/// The capacity for `count` sub-voxels: memory grows in few steps.
constexpr std::size_t room_for(std::size_t count) {
  return (count + 7) / 8 * 8;
}

/// Calls `visit(place)` for each bit.
template <class Visit>
void for_each_place(std::uint64_t places, Visit&& visit) {
  for (; places != 0; places &= places - 1) visit(std::countr_zero(places));
}

}  // namespace

SubVoxel& SubVoxels::at(int place) {
  const std::uint64_t bit = std::uint64_t{1} << place;
  const auto before = static_cast<std::size_t>(std::popcount(places_ & (bit - 1)));
  if ((places_ & bit) != 0) return cells_[before];
  const std::size_t size = count();
  if (size == room_for(size)) {
    auto larger = std::make_unique<SubVoxel[]>(room_for(size + 1));
    std::copy_n(cells_.get(), size, larger.get());
    cells_ = std::move(larger);
  }
  std::copy_backward(cells_.get() + before, cells_.get() + size, cells_.get() + size + 1);
  places_ |= bit;
  return cells_[before] = SubVoxel{};
}

bool SubVoxels::holds(std::size_t scan) const {
  const auto cells = all();
  return std::any_of(cells.begin(), cells.end(),
                     [&](const SubVoxel& cell) { return cell.holds(scan); });
}

std::vector<StaticMap::Seed> StaticMap::seeds_in(const std::vector<VoxelIndex>& newly_free) const {
  std::vector<Seed> seeds;
  for (const VoxelIndex& voxel : newly_free) {
    const Number number = find(voxel);
    if (number == VoxelNumbers::kNone) continue;
    for (const SubVoxel& cell : voxels_[number].all()) {
      if (!cell.is(Level::kEmpty)) seeds.push_back({cell.scan, number});
    }
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

void StaticMap::remove(const std::vector<VoxelIndex>& newly_free) {
  const std::vector<Seed> seeds = seeds_in(newly_free);
  touched_.clear();
  for (std::size_t begin = 0; begin < seeds.size();) {
    std::size_t end = begin;
    while (end < seeds.size() && seeds[end].scan == seeds[begin].scan) ++end;
    grow(std::span(seeds).subspan(begin, end - begin));
    begin = end;
  }
  clear_without_static();
}

void StaticMap::grow(std::span<const Seed> seeds) {
  const std::uint32_t scan = seeds.front().scan;
  ++growths_;
  std::vector<Number> frontier;
  const auto reach = [&](Number voxel, Level level, std::vector<Number>& reached) {
    if (reached_[voxel] == growths_) return;
    reached_[voxel] = growths_;
    if (!voxels_[voxel].holds(scan)) return;
    raise(voxel, scan, level);
    reached.push_back(voxel);
  };
  for (const Seed& seed : seeds) reach(seed.voxel, Level::kConservative, frontier);
  for (const Level level : {Level::kModerate, Level::kAggressive}) {
    std::vector<Number> reached;
    for (const Number voxel : frontier) {
      for_each_around(voxel_index(keys_[voxel]), 1, [&](const VoxelIndex& at) {
        const Number number = find(at);
        if (number != VoxelNumbers::kNone) reach(number, level, reached);
      });
    }
    frontier = std::move(reached);
  }
}

void StaticMap::raise(Number voxel, std::uint32_t scan, Level level) {
  for (SubVoxel& cell : voxels_[voxel].all()) {
    if (cell.holds(scan) && cell.level < static_cast<std::uint32_t>(level)) cell.set(scan, level);
  }
  touched_.push_back(voxel);
}

void StaticMap::clear_without_static() {
  for (const Number voxel : touched_) {
    const auto cells = voxels_[voxel].all();
    const bool has_static = std::any_of(
        cells.begin(), cells.end(), [](const SubVoxel& cell) { return cell.is(Level::kStatic); });
    if (!has_static) std::fill(cells.begin(), cells.end(), SubVoxel{});
  }
}

void StaticMap::integrate(const ScanMap& voxels, std::size_t scan) {
  for (const ScanVoxel& voxel : voxels.voxels()) {
    const Number number = numbers_.add(voxel_key(voxel.at), key_of());
    if (number == keys_.size()) {
      keys_.push_back(voxel_key(voxel.at));
      voxels_.emplace_back();
      reached_.push_back(0);
    }
    const auto level = static_cast<std::uint32_t>(voxel.level);
    for_each_place(voxel.sub_voxels, [&](int place) {
      SubVoxel& cell = voxels_[number].at(place);
      if (cell.level <= level) return;
      cell.set(scan, voxel.level);
    });
  }
}

CellSet StaticMap::removed() const {
  CellSet removed;
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    const VoxelIndex voxel = voxel_index(keys_[i]);
    const SubVoxel* cell = voxels_[i].all().data();
    for_each_place(voxels_[i].places(), [&](int place) {
      if (!(cell++)->is(Level::kStatic)) {
        removed.insert(voxel_key(sub_voxel_at(voxel, place)));
      }
    });
  }
  return removed;
}

Level StaticMap::level_of(const VoxelIndex& sub_voxel) const {
  const Number number = find(voxel_of(sub_voxel));
  if (number == VoxelNumbers::kNone) return Level::kEmpty;
  const std::uint64_t bit = std::uint64_t{1} << place_of(sub_voxel);
  const SubVoxels& cells = voxels_[number];
  if ((cells.places() & bit) == 0) return Level::kEmpty;
  const auto before = static_cast<std::size_t>(std::popcount(cells.places() & (bit - 1)));
  return static_cast<Level>(cells.all()[before].level);
}

}  // namespace raymoval::freedom_method
