// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_maps.h"
#include "methods/raymoval_plus/objects/objects.h"
#include "methods/raymoval_plus/objects/tracks.h"

namespace raymoval::raymoval_plus_method {

/// The objects of the last scans, and the voxels that each of them consists of. What a scan took
/// for static is known to have moved once a later scan sees through its place, so that the objects
/// are judged again by each state of the map. Tracks through them reach the scan that is to be
/// answered.
class RecentObjects {
 public:
  explicit RecentObjects(const Parameters& parameters);

  /// Takes the clusters of a scan, after those of the scans before. Those of a scan that it has
  /// already are replaced. At most the last `recent_scans` up to the first scan that waits are
  /// kept.
  void take(const SegmentedScan& scan, const EvidenceMap& map, const RunContext& context);
  /// Adds the blocks of the objects' voxels to those that are there, each once.
  void add_blocks(const EvidenceMap& map, std::vector<std::uint32_t>& blocks) const;
  /// Counts anew what is dynamic in the objects.
  void judge(const EvidenceMap& map, const RunContext& context);
  /// The clusters of a scan that tracks mark.
  [[nodiscard]] std::vector<int> marked(std::size_t scan, const RunContext& context) const;
  /// Forgets the scans that are too old for the answer of scan `next`.
  void forget_before(std::size_t next);

 private:
  /// Points of one object in one voxel.
  struct Piece {
    std::uint32_t object;  ///< Its number among those of the scan.
    std::uint32_t voxel;
    std::uint32_t points;
  };
  /// What is kept of a scan beside its objects.
  struct Pieces {
    std::vector<Piece> all;
    std::vector<std::uint32_t> blocks;
  };
  [[nodiscard]] Pieces pieces_of(const SegmentedScan& scan, const EvidenceMap& map,
                                 const std::vector<ObjectSummary>& objects) const;

  Parameters parameters_;
  ObjectTracker before_;   ///< The tracks up to the first scan that is kept.
  std::size_t first_ = 0;  ///< The scan that comes first in both lists.
  std::vector<std::vector<ObjectSummary>> objects_;
  std::vector<Pieces> pieces_;
};

}  // namespace raymoval::raymoval_plus_method
