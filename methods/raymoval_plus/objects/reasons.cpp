// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/reasons.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// In the order of `reason_sentences`.
enum class Reason : std::uint8_t {
  kNothingSeen,
  kGroundOrWas,
  kSeenThrough,
  kNeighboursRemove,
  kNeighboursKeep,
  kObjectRemoved,
  kObjectKept,
  kStandsOnRemoved,
  kStandsOnKept,
};

Reason reason_of_voxel(const EvidenceMap& map, std::uint32_t voxel, bool is_removed) {
  const bool was_seen_through = map.decision(voxel) == Verdict::kDynamic;
  if (is_removed) return was_seen_through ? Reason::kSeenThrough : Reason::kNeighboursRemove;
  return was_seen_through ? Reason::kNeighboursKeep : Reason::kNothingSeen;
}

/// The reason for what the maps say of a point.
Reason reason_of_maps(const EvidenceMaps& maps, const LocatedScan& scan, std::size_t k) {
  const bool is_removed = scan.verdict[k] == Verdict::kDynamic;
  if (scan.has_standing_voxel(k)) {
    return reason_of_voxel(maps.standing, scan.voxel[k], is_removed);
  }
  return is_removed ? reason_of_voxel(maps.ground, scan.ground_voxel[k], true)
                    : Reason::kGroundOrWas;
}

}  // namespace

std::vector<std::string> reason_sentences() {
  return {"no scan, or too few, saw through its voxel",
          "it is ground, or was when its scan came",
          "scans saw through its voxel, more than agree with it allow",
          "most of the decided voxels around its own were seen through",
          "its voxel was seen through, but few of the voxels around it were",
          "it belongs to an object that was seen moving or is mostly seen through",
          "it belongs to an object that hardly anything was seen through",
          "what stands above it moved",
          "what stands above it stays"};
}

std::vector<std::uint8_t> reasons_for(const SegmentedScan& scan, const EvidenceMaps& maps,
                                      const Verdicts& by_objects, const Verdicts& decided) {
  std::vector<std::uint8_t> reasons(scan.verdict.size());
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    const bool of_voxel = scan.verdict[k] == Verdict::kDynamic;
    const bool of_object = by_objects[k] == Verdict::kDynamic;
    const bool removed = decided[k] == Verdict::kDynamic;
    Reason reason = reason_of_maps(maps, scan, k);
    if (of_object != of_voxel) reason = of_object ? Reason::kObjectRemoved : Reason::kObjectKept;
    if (removed != of_object) reason = removed ? Reason::kStandsOnRemoved : Reason::kStandsOnKept;
    reasons[k] = static_cast<std::uint8_t>(reason);
  }
  return reasons;
}

}  // namespace raymoval::raymoval_plus_method
