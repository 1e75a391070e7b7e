// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_map.h"
#include "methods/raymoval_plus/evidence/range_image.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// Step 3: asks a scan's range image about every voxel within its evidence range, and adds what it
/// says to the voxel's evidence. Step 4: decides on these voxels anew.
void add_evidence(const RangeImage& image, const Pose& T_world_sensor, const Parameters& parameters,
                  const RunContext& context, EvidenceMap& map);

/// The range images of some earlier scans. Where scans are read only once, a new voxel gets its
/// evidence from these, from the scan that found it, and from those that follow.
class EarlierScans {
 public:
  explicit EarlierScans(const Parameters& parameters) : parameters_(parameters) {}

  /// Steps 3 and 4 for the voxels from number `first_voxel` on.
  /// @param center position of the sensor that found them, world frame, metres
  void add_evidence(std::size_t first_voxel, const Eigen::Vector3d& center,
                    const RunContext& context, EvidenceMap& map) const;
  /// Takes the next scan. One of `history_step` scans is kept, and at most the last
  /// `history_scans`.
  void keep(const RangeImage& image, const Pose& T_world_sensor);

 private:
  struct EarlierScan {
    RangeImage image;
    Pose T_sensor_world;
  };
  Parameters parameters_;
  std::size_t scans_ = 0;
  std::vector<EarlierScan> kept_;  ///< The oldest comes first.
};

/// Step 3 for one voxel: adds what one scan says. Scans come in order of time.
/// @param range distance of the voxel from the sensor, metres
void add_observation(Observation observation, float range, const Parameters& parameters,
                     VoxelEvidence& evidence);

/// Step 4 for one voxel: static, dynamic or undecided.
Verdict decide(const VoxelEvidence& evidence, const Parameters& parameters);

/// Whether enough scans agree with a voxel and none saw through it: it was there all the time.
bool was_always_there(const VoxelEvidence& evidence, const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
