// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/online/recent_objects.h"

#include <algorithm>
#include <utility>

#include "methods/raymoval_plus/objects/journeys.h"

namespace raymoval::raymoval_plus_method {

RecentObjects::RecentObjects(const Parameters& parameters)
    : parameters_(parameters), before_(parameters) {}

void RecentObjects::take(const SegmentedScan& scan, const EvidenceMap& map,
                         const RunContext& context) {
  std::vector<ObjectSummary> objects = summarise_objects(scan, map, parameters_, context);
  Pieces pieces = pieces_of(scan, map, objects);
  const std::size_t index = scan.scan.index;
  if (objects_.empty()) first_ = index;
  if (index - first_ == objects_.size()) {
    objects_.emplace_back();
    pieces_.emplace_back();
  }
  objects_[index - first_] = std::move(objects);
  pieces_[index - first_] = std::move(pieces);
}

RecentObjects::Pieces RecentObjects::pieces_of(const SegmentedScan& scan, const EvidenceMap& map,
                                               const std::vector<ObjectSummary>& objects) const {
  constexpr std::uint32_t kNoObject = 0xFFFFFFFFU;
  std::vector<std::uint32_t> object_of(scan.clusters.size(), kNoObject);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    object_of[static_cast<std::size_t>(objects[i].cluster)] = static_cast<std::uint32_t>(i);
  }
  Pieces pieces;
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const std::uint32_t object = object_of[static_cast<std::size_t>(scan.cluster_of[i])];
    const std::uint32_t voxel = scan.voxel[scan.high_points[i]];
    if (object == kNoObject || voxel == EvidenceMap::kNone) continue;
    // Points of a scan come ring by ring, so that those of a voxel mostly follow each other.
    if (!pieces.all.empty() && pieces.all.back().voxel == voxel &&
        pieces.all.back().object == object) {
      ++pieces.all.back().points;
    } else {
      pieces.all.push_back({object, voxel, 1});
    }
  }
  for (const Piece& piece : pieces.all) pieces.blocks.push_back(map.block_of(piece.voxel));
  std::sort(pieces.blocks.begin(), pieces.blocks.end());
  pieces.blocks.erase(std::unique(pieces.blocks.begin(), pieces.blocks.end()), pieces.blocks.end());
  return pieces;
}

void RecentObjects::add_blocks(const EvidenceMap& map, std::vector<std::uint32_t>& blocks) const {
  std::vector<std::uint8_t> is_there(map.blocks().block_count(), 0);
  for (const std::uint32_t block : blocks) is_there[block] = 1;
  for (const Pieces& pieces : pieces_) {
    for (const std::uint32_t block : pieces.blocks) {
      if (std::exchange(is_there[block], std::uint8_t{1}) == 0) blocks.push_back(block);
    }
  }
}

void RecentObjects::judge(const EvidenceMap& map, const RunContext& context) {
  const StageScope timed(context.times, "recent objects");
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    for (ObjectSummary& object : objects_[i]) object.evidence = {};
    for (const Piece& piece : pieces_[i].all) {
      add_evidence_of(piece.voxel, piece.points, map, objects_[i][piece.object].evidence);
    }
  }
}

std::vector<int> RecentObjects::marked(std::size_t scan, const RunContext& context) const {
  const StageScope timed(context.times, "tracks");
  ObjectTracker forward = before_, backward(parameters_);
  for (std::size_t i = 0; i < objects_.size(); ++i) forward.follow(first_ + i, objects_[i]);
  std::vector<int> marked = marked_in(scan, forward.finish(), parameters_);
  for (std::size_t i = objects_.size(); i > 0 && first_ + i > scan + 1; --i) {
    backward.follow(first_ + i - 1, objects_[i - 1]);
  }
  // Without later scans nothing leads back to this one.
  if (first_ + objects_.size() <= scan + 1) return marked;
  backward.follow(scan, objects_[scan - first_]);
  const std::vector<int> more = marked_in(scan, backward.finish(), parameters_);
  marked.insert(marked.end(), more.begin(), more.end());
  return marked;
}

void RecentObjects::forget_before(std::size_t next) {
  const auto kept = static_cast<std::size_t>(parameters_.recent_scans);
  while (!objects_.empty() && first_ + kept < next) {
    before_.follow(first_, objects_.front());
    before_.forget_ended();
    objects_.erase(objects_.begin());
    pieces_.erase(pieces_.begin());
    ++first_;
  }
}

}  // namespace raymoval::raymoval_plus_method
