// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/beam_image.h"
#include "methods/raymoval_plus/evidence/evidence_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// The image of a scan, and where it was taken.
struct PosedImage {
  const BeamImage* image = nullptr;
  Eigen::Vector3d position;  ///< Of the sensor, world frame, metres.
  std::size_t scan = 0;      ///< Its number.
};

/// When step 4 decides on voxels: after each scan, or by `decide_all` at the end.
enum class WhenToDecide : std::uint8_t { kNow, kLater };

/// Step 3: asks the range images of scans about every voxel within their evidence range, and adds
/// what they say to the voxel's evidence. Step 4: decides on these voxels anew, if it is to be now.
/// @param images in order of time
void add_evidence(std::span<const PosedImage> images, const Parameters& parameters,
                  WhenToDecide when, const RunContext& context, EvidenceMap& map);
/// Step 4 for all voxels.
void decide_all(const Parameters& parameters, const RunContext& context, EvidenceMap& map);

/// The range images of some earlier scans. Where scans are read only once, a new voxel gets its
/// evidence from these, from the scan that found it, and from those that follow.
class EarlierScans {
 public:
  explicit EarlierScans(const Parameters& parameters) : parameters_(parameters) {}

  /// Steps 3 and 4 for the voxels from number `first_voxel` on.
  /// @param center position of the sensor that found them, world frame, metres
  void add_evidence(std::size_t first_voxel, const Eigen::Vector3d& center, WhenToDecide when,
                    const RunContext& context, EvidenceMap& map) const;
  /// Takes the next scan. The last `history_scans` are kept. The image that is left is to be filled
  /// anew.
  /// @param scan its number
  void keep(BeamImage&& image, std::size_t scan);

 private:
  struct EarlierScan {
    BeamImage image;
    std::size_t number;
  };
  Parameters parameters_;
  std::vector<EarlierScan> kept_;  ///< The oldest comes first.
};

/// Step 3 for one voxel: adds what one scan says. Scans come in order of time.
void add_observation(Observation observation, std::size_t scan, VoxelEvidence& evidence);

/// The share of a voxel's observations that contradict it: scans that passed before the first hit
/// or after the last one, from 0 to 1. Hits count up to ten, so that what stood for long and left
/// can be told.
[[nodiscard]] float contradiction(const VoxelEvidence& evidence);

/// Whether so few scans hit a voxel that what is open around it counts as passing it.
[[nodiscard]] bool has_few_hits(const VoxelEvidence& evidence);

/// Whether many scans hit a voxel and next to none contradicts it.
[[nodiscard]] bool is_firm(const VoxelEvidence& evidence);

/// Step 4 for one voxel: static, dynamic or undecided.
Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters);

/// The numbers of the first and of the last scan that hit a voxel. Where none does, a point's own
/// scan is both.
struct HitSpan {
  std::uint32_t first, last;
};
inline HitSpan hit_span(const VoxelEvidence& evidence, std::size_t own_scan) {
  if (evidence.hits > 0) return {evidence.first_hit, evidence.last_hit};
  const auto own = static_cast<std::uint32_t>(own_scan);
  return {own, own};
}

}  // namespace raymoval::raymoval_plus_method
