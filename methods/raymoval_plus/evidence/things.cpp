// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/things.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// Voxels of a thing are at most so far apart, metres.
constexpr double kThingReach = 0.6;
constexpr double kRounding = 1e-9;  // Three voxels of 0.2 m are not to be more than 0.6 m.
/// Their presences begin and end so many scans apart, and this share of both together.
constexpr double kEndsApart = 5.0, kEndsApartShare = 0.1;
/// What is open counts so much of what passes.
constexpr float kOpenWeight = 0.5F;
/// Blocks that a thread takes at a time. It changes no answer.
constexpr std::size_t kThingBlocksATask = 64;

bool are_alike(const Presence& a, const Presence& b) {
  const std::uint32_t begin = std::min(a.first, b.first), end = std::max(a.last, b.last);
  const std::uint32_t later = std::max(a.first, b.first), sooner = std::min(a.last, b.last);
  return (later - begin) + (end - sooner) <= kEndsApart + kEndsApartShare * (end - begin + 1);
}

float passes_outside(const VoxelIndex& cell, const VoxelEvidence& evidence,
                     const Surroundings& around) {
  constexpr int kKept = VoxelEvidence::kPasses;
  const int before = std::min<int>(evidence.passes_before, kKept);
  const int after = std::min<int>(evidence.passes_after, kKept);
  float passes = 0.0F;
  if (has_few_hits(evidence)) {
    passes = kOpenWeight * static_cast<float>(evidence.open_before + evidence.open_after);
  }
  if (before + after > 0) {
    const Presence thing = around.presence_of_thing(cell);
    const auto is_outside = [&](std::uint32_t scan) {
      return scan < thing.first || scan > thing.last;
    };
    const auto *const first = evidence.first_passes.data(), *const last =
                                                                evidence.last_passes.data();
    passes += static_cast<float>(std::count_if(first, first + before, is_outside) +
                                 std::count_if(last, last + after, is_outside));
  }
  return std::min(passes, static_cast<float>(kKept));
}

}  // namespace

Surroundings::Surroundings(double voxel_size)
    : reach_(std::max(1, static_cast<int>(std::floor(kThingReach / voxel_size + kRounding)))),
      side_(kSide + 2 * reach_),
      presences_(static_cast<std::size_t>(side_ * side_ * side_)),
      voxels_(presences_.size()) {
  for (int z = -reach_; z <= reach_; ++z) {
    for (int y = -reach_; y <= reach_; ++y) {
      for (int x = -reach_; x <= reach_; ++x) {
        if (x * x + y * y + z * z <= reach_ * reach_) steps_.push_back(place({x, y, z}));
      }
    }
  }
}

void Surroundings::look_at(std::uint32_t block, const EvidenceMap& map) {
  const VoxelIndex region = region_of(map.blocks().block_index(block));
  if (region_ == region) return;
  region_ = region;
  std::fill(presences_.begin(), presences_.end(), Presence{});
  corner_ = region * kSide - VoxelIndex::Constant(reach_);
  const VoxelIndex low = EvidenceMap::Blocks::block_of(corner_);
  const VoxelIndex high = EvidenceMap::Blocks::block_of(corner_.array() + side_ - 1);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) read_block({x, y, z}, map);
    }
  }
}

void Surroundings::read_block(const VoxelIndex& index, const EvidenceMap& map) {
  const std::uint32_t block = map.blocks().block(index);
  if (block == EvidenceMap::kNone) return;
  const VoxelIndex corner = index * kBlockSide - corner_;
  for_voxels(map, block, [&](std::uint32_t voxel, std::size_t i) {
    const VoxelIndex cell = corner + EvidenceMap::Blocks::cell_at(i);
    if ((cell.array() < 0).any() || (cell.array() >= side_).any()) return;
    const VoxelEvidence& evidence = map.evidence(voxel);
    if (evidence.hits == 0) return;
    presences_[place(cell)] = {evidence.first_hit, evidence.last_hit};
    voxels_[place(cell)] = voxel;
  });
}

template <class Visit>
void Surroundings::for_cells_of_thing(const VoxelIndex& cell, Visit&& visit) const {
  const std::size_t center = place(cell - corner_);
  const Presence& own = presences_[center];
  for (const std::size_t step : steps_) {
    const std::size_t at = center + step;  // Steps back wrap around.
    if (!presences_[at].is_any()) continue;
    if (!own.is_any() || are_alike(own, presences_[at])) visit(at);
  }
}

Presence Surroundings::presence_of_thing(const VoxelIndex& cell) const {
  Presence all;
  for_cells_of_thing(cell, [&](std::size_t at) {
    all.first = std::min(all.first, presences_[at].first);
    all.last = std::max(all.last, presences_[at].last);
  });
  return all;
}

float Surroundings::passes_of_thing(const VoxelIndex& cell, const EvidenceMap& map) const {
  float passes = 0.0F;
  int voxels = 0;
  for_cells_of_thing(cell, [&](std::size_t at) {
    passes += map.evidence(voxels_[at]).passes_outside;
    ++voxels;
  });
  return passes / static_cast<float>(std::max(voxels, 1));
}

void find_passes_outside(std::vector<std::uint32_t> blocks, const RunContext& context,
                         EvidenceMap& map) {
  const StageScope timed(context.times, "passes outside");
  // A region is read once, whatever the order of its blocks.
  const auto region = [&](std::uint32_t block) {
    return voxel_key(Surroundings::region_of(map.blocks().block_index(block)));
  };
  std::sort(blocks.begin(), blocks.end(),
            [&](std::uint32_t a, std::uint32_t b) { return region(a) < region(b); });
  parallel_chunks(
      context.threads, blocks.size(), kThingBlocksATask, [&](std::size_t begin, std::size_t end) {
        Surroundings around(map.voxel_size());
        for (std::size_t i = begin; i < end; ++i) {
          for_voxels(map, blocks[i], [&](std::uint32_t voxel, std::size_t) {
            VoxelEvidence& evidence = map.evidence(voxel);
            evidence.passes_outside = 0.0F;
            if (is_firm(evidence)) return;
            if (evidence.passes_before + evidence.passes_after > 0) around.look_at(blocks[i], map);
            evidence.passes_outside = passes_outside(map.index(voxel), evidence, around);
          });
        }
      });
}

}  // namespace raymoval::raymoval_plus_method
