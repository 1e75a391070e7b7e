// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/sensor_model.h"
#include "core/stage_timer.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/range_image.h"
#include "methods/raymoval_plus/terrain.h"
#include "methods/raymoval_plus/world_scan.h"

namespace raymoval {

/// Terrain, voxels and evidence from scans in order of time, each seen once. A voxel is asked of
/// the scan that found it, of those that follow, and of some that came before and were kept.
class ArrivingScans {
 public:
  ArrivingScans(const SensorModel& sensor, const RaymovalPlusParameters& parameters);

  /// Takes the next scan and returns it with heights and voxels.
  WorldScan add(Scan scan, int threads, StageTimes* times);

  [[nodiscard]] const Terrain& terrain() const { return terrain_; }
  [[nodiscard]] const EvidenceMap& map() const { return map_; }
  [[nodiscard]] EvidenceMap& map() { return map_; }

 private:
  struct Kept {
    RangeImage image;
    Pose T_sensor_world;
  };
  /// @param center the sensor, in the world frame
  void ask_kept_scans(std::size_t first_voxel, const Eigen::Vector3d& center, int threads);
  void keep(RangeImage image, const Pose& T_world_sensor);

  RaymovalPlusParameters parameters_;
  Terrain terrain_;
  EvidenceMap map_;
  RangeImage image_;
  std::size_t scans_ = 0;
  std::vector<Kept> kept_;  ///< Oldest first.
};

}  // namespace raymoval
