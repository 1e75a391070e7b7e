// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// The number of new voxels that a thread asks all kept scans about at a time. A scan finds some
/// thousands, so that all threads have work. It changes no answer.
constexpr std::size_t kVoxelsATask = 256;

/// Hits count up to this number, so that what stood for long and left can be told.
constexpr int kMostHits = 10;
/// With so few hits, what is open around a voxel counts as passing it.
constexpr int kFewHits = 3;
/// A firm voxel is contradicted less than this.
constexpr float kFirm = 0.1F;

/// The tiles that any of the scans may say something of.
std::vector<std::uint32_t> tiles_near(std::span<const PosedImage> images, double range,
                                      const EvidenceMap& map) {
  std::vector<std::uint32_t> tiles;
  for (const PosedImage& scan : images) {
    const auto near = map.tiles_near(scan.position, range);
    tiles.insert(tiles.end(), near.begin(), near.end());
  }
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

}  // namespace

void add_evidence(std::span<const PosedImage> images, const Parameters& parameters,
                  WhenToDecide when, const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  map.update_means();
  const auto tiles = tiles_near(images, parameters.evidence_range_max, map);
  // A thread takes one tile at a time, so that one thread decides on all voxels of a block, and the
  // tile's voxels stay in its cache from scan to scan.
  parallel_for(context.threads, tiles.size(), 1, [&](std::size_t t) {
    EvidenceMap::Tile& tile = map.tile(tiles[t]);
    thread_local std::vector<ObservedVoxel> observed;
    for (const auto& [image, position, scan] : images) {
      image->observe(tile.places, tile.shapes, tile.origin, observed);
      for (const ObservedVoxel& voxel : observed) {
        const std::uint32_t number = tile.voxels[voxel.place];
        VoxelEvidence& evidence = map.evidence(number);
        add_observation(voxel.observation, scan, evidence);
        if (when == WhenToDecide::kNow) map.set_decision(number, decide(evidence, parameters));
      }
    }
  });
}

void decide_all(const Parameters& parameters, const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  for (std::size_t voxel = 0; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decide(map.evidence(voxel), parameters));
  }
}

void EarlierScans::add_evidence(std::size_t first_voxel, const Eigen::Vector3d& center,
                                WhenToDecide when, const RunContext& context,
                                EvidenceMap& map) const {
  const StageScope timed(context.times, "earlier scans");
  const std::size_t fresh = map.size() - first_voxel;
  parallel_chunks(context.threads, fresh, kVoxelsATask, [&](std::size_t begin, std::size_t end) {
    std::vector<float> places;
    std::vector<VoxelShape> shapes;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f place = (map.centroid(first_voxel + i) - center).cast<float>();
      places.insert(places.end(), place.data(), place.data() + 3);
      shapes.push_back(map.shape(first_voxel + i));
    }
    std::vector<ObservedVoxel> observed;
    for (const EarlierScan& scan : kept_) {
      scan.image.observe(places, shapes, center, observed);
      for (const ObservedVoxel& voxel : observed) {
        add_observation(voxel.observation, scan.number,
                        map.evidence(first_voxel + begin + voxel.place));
      }
    }
  });
  if (when == WhenToDecide::kLater) return;
  for (std::size_t voxel = first_voxel; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decide(map.evidence(voxel), parameters_));
  }
}

void EarlierScans::keep(BeamImage&& image, std::size_t scan) {
  if (parameters_.history_scans == 0) return;
  image.forget_points();
  if (kept_.size() < static_cast<std::size_t>(parameters_.history_scans)) {
    kept_.push_back({std::move(image), scan});
    return;
  }
  // The memory of the oldest image is that of the next one.
  std::rotate(kept_.begin(), kept_.begin() + 1, kept_.end());
  std::swap(kept_.back().image, image);
  kept_.back().number = scan;
}

void add_observation(Observation observation, std::size_t scan, VoxelEvidence& evidence) {
  const auto count_up = [](std::uint16_t& count) {
    if (count < 0xFFFFU) ++count;
  };
  const auto number = static_cast<std::uint32_t>(scan);
  const bool was_hit = evidence.hits > 0;
  if (observation == Observation::kHit) {
    evidence.last_hit = number;
    if (!was_hit) evidence.first_hit = number;
    count_up(evidence.hits);
    evidence.passes_after = evidence.open_after = 0;
  } else if (observation == Observation::kPassed && was_hit) {
    evidence.last_passes[evidence.passes_after % VoxelEvidence::kPasses] = number;
    count_up(evidence.passes_after);
  } else if (observation == Observation::kPassed) {
    if (evidence.passes_before < VoxelEvidence::kPasses) {
      evidence.first_passes[evidence.passes_before] = number;
    }
    count_up(evidence.passes_before);
  } else if (observation == Observation::kOpen) {
    count_up(was_hit ? evidence.open_after : evidence.open_before);
  }
}

bool has_few_hits(const VoxelEvidence& evidence) {
  return evidence.hits <= kFewHits;
}

float contradiction(const VoxelEvidence& evidence) {
  int outside = evidence.passes_before + evidence.passes_after;
  if (has_few_hits(evidence)) outside += evidence.open_before + evidence.open_after;
  const int hits = std::min<int>(evidence.hits, kMostHits);
  return static_cast<float>(outside) / static_cast<float>(outside + hits + 1);
}

bool is_firm(const VoxelEvidence& evidence) {
  return evidence.hits >= kMostHits && contradiction(evidence) < kFirm;
}

Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters) {
  if (contradiction(evidence) >= parameters.voxel_contradiction) return Verdict::kDynamic;
  return evidence.hits >= parameters.static_hits ? Verdict::kStatic : Verdict::kUndecided;
}

}  // namespace raymoval::raymoval_plus_method
