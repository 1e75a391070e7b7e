// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/evidence.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// The number of new voxels that a thread asks all kept scans about at a time. A scan finds some
/// thousands, so that all threads have work. It changes no answer.
constexpr std::size_t kVoxelsATask = 256;

/// Hits count up to this number, so that what stood for long and left can be told.
constexpr int kMostHits = 10;
const int kFewHits = getenv("FEWH") ? atoi(getenv("FEWH")) : 3;

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
        VoxelEvidence& evidence = tile.evidence[voxel.place];
        add_observation(voxel.observation, scan, evidence);
        if (when == WhenToDecide::kNow) map.set_decision(tile.voxels[voxel.place], decide(evidence, parameters));
      }
    }
  });
}

void decide_all(const Parameters& parameters, const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "evidence");
  find_scores(context, map);
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
        add_observation(voxel.observation, scan.number, map.evidence(first_voxel + begin + voxel.place));
      }
    }
  });
  if (when == WhenToDecide::kLater) return;
  for (std::size_t voxel = first_voxel; voxel < map.size(); ++voxel) {
    map.set_decision(voxel, decide(map.evidence(voxel), parameters_));
  }
}

void EarlierScans::keep(BeamImage&& image, std::size_t scan) {
  const bool is_kept = scans_++ % static_cast<std::size_t>(parameters_.history_step) == 0;
  if (!is_kept || parameters_.history_scans == 0) return;
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
  const std::uint64_t slot = std::uint64_t{1} << std::min(63, static_cast<int>(scan * slots_per_scan));
  if (observation == Observation::kHit) {
    evidence.hit_slots |= slot;
    evidence.last_agree = static_cast<std::uint32_t>(scan);
    if (evidence.agree_scans == 0) evidence.first_agree = evidence.last_agree;
    count_up(evidence.agree_scans);
    evidence.trailing_free = evidence.trailing_open = 0;
  } else if (observation == Observation::kPassed) {
    count_up(evidence.free_scans);
    evidence.pass_slots |= slot;
    count_up(evidence.trailing_free);
    if (evidence.agree_scans == 0) count_up(evidence.leading_free);
  } else if (observation == Observation::kOpen) {
    evidence.open_slots |= slot;
    count_up(evidence.agree_scans == 0 ? evidence.leading_open : evidence.trailing_open);
  }
}

namespace {
double env(const char* name, double otherwise) {
  const char* text = getenv(name);
  return text != nullptr ? atof(text) : otherwise;
}
const double kSat = env("SAT", 6), kHc = env("HC", 3), kTau = env("TAU", 0.3), kSl = env("SL", 1), kOw = env("OW", 0.5), kSum = env("SUM", 0);
const int kR = static_cast<int>(env("LR", 3));
struct Interval { int first = 99, last = -1; };
Interval interval_of(const VoxelEvidence& e) {
  if (e.hit_slots == 0) return {};
  return {std::countr_zero(e.hit_slots), 63 - std::countl_zero(e.hit_slots)};
}
}  // namespace

void find_scores(const RunContext& context, EvidenceMap& map) {
  if (getenv("OWN") != nullptr) return;
  const int radius = map.is_fine() ? kR : static_cast<int>(env("GR", 1));
  parallel_chunks(context.threads, map.size(), 1024, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor cursor;
    for (std::size_t v = begin; v < end; ++v) {
      VoxelEvidence& e = map.evidence(v);
      Interval all = interval_of(e);
      const Interval own = all;
      const double h = std::min<double>(kHc, std::max<int>(1, e.agree_scans));
      const bool few = e.agree_scans <= kFewHits;
      if (e.leading_free + e.trailing_free + (few ? e.leading_open + e.trailing_open : 0) == 0) { e.score = 0; continue; }
      for (int z = -radius; z <= radius; ++z) for (int y = -radius; y <= radius; ++y) for (int x = -radius; x <= radius; ++x) {
        if (x * x + y * y + z * z > radius * radius) continue;
        const std::size_t slot = map.find_slot(map.index(v) + VoxelIndex(x, y, z), cursor);
        if (slot == EvidenceMap::Blocks::kNoSlot) continue;
        const std::uint32_t other = map.voxel_in(slot);
        if (other == EvidenceMap::kNone || other == v) continue;
        const Interval f = interval_of(map.evidence(other));
        if (f.last < 0) continue;
        if (own.last >= 0) {
          const double in = std::min(own.last, f.last) - std::max(own.first, f.first) + 1 + kSl;
          const double un = std::max(own.last, f.last) - std::min(own.first, f.first) + 1 + kSl;
          if (in < kTau * un) continue;
        }
        all.first = std::min(all.first, f.first);
        all.last = std::max(all.last, f.last);
      }
      std::uint64_t inside = 0;
      if (all.last >= 0) inside = (all.last >= 63 ? ~std::uint64_t{0} : (std::uint64_t{1} << (all.last + 1)) - 1) & ~((std::uint64_t{1} << all.first) - 1);
      double o = std::popcount(e.pass_slots & ~inside);
      if (few) o += kOw * std::popcount(e.open_slots & ~inside & ~e.pass_slots);
      o = std::min(o, kSat);
      e.score = static_cast<float>(kSum > 0 ? o / h : getenv("LOCAL") ? o / (o + h) : o);
    }
  });
}

float contradiction(const VoxelEvidence& evidence) {
  static const bool local = getenv("LOCAL") != nullptr;
  if (local && evidence.score >= 0) return evidence.score;
  const bool is_hit = evidence.agree_scans > 0;
  float outside = static_cast<float>(evidence.leading_free) + (is_hit ? static_cast<float>(evidence.trailing_free) : 0.0F);
  if (evidence.agree_scans <= kFewHits) outside += static_cast<float>(evidence.leading_open + evidence.trailing_open);
  return outside / (outside + static_cast<float>(std::min<int>(evidence.agree_scans, kMostHits)) + 1.0F);
}

bool is_firm(const VoxelEvidence& evidence) {
  return evidence.agree_scans >= kMostHits && contradiction(evidence) < 0.1F;
}

Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters) {
  if (contradiction(evidence) >= parameters.voxel_share) return Verdict::kDynamic;
  return evidence.agree_scans >= parameters.static_agree ? Verdict::kStatic : Verdict::kUndecided;
}

bool is_settled(const VoxelEvidence& evidence, const Parameters& parameters) {
  return parameters.settled_scans > 0 && evidence.agree_scans >= parameters.settled_scans;
}

bool was_always_there(const VoxelEvidence& evidence, const Parameters& parameters) {
  return evidence.free_scans == 0 && is_settled(evidence, parameters);
}

}  // namespace raymoval::raymoval_plus_method
