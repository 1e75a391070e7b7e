// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/scan/sensor_model.h"
#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/first_hit.h"
#include "methods/raymoval/map_reference.h"
#include "methods/raymoval/parameters.h"
#include "methods/raymoval/static_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_method {

/// The grid of directions that `parameters` ask for with this sensor (eq. 2).
AngularGrid grid_for(const SensorModel& sensor, const Parameters& parameters);

/// One scan against a map: the steps of section 3 in their order, each of which needs those before
/// it. It keeps its memory from scan to scan; each thread at work needs one of its own.
/// @note all scans must be compared with one and the same map, which may change between them
class ScanAgainstMap {
 public:
  /// @param parameters must outlive this
  ScanAgainstMap(const Parameters& parameters, const SensorModel& sensor);

  /// Eqs 1-3 and 10. It also finds the voxel of each point.
  void project_scan(Scan scan, const RunContext& context);
  /// Eqs 4-7. It changes nothing of a map whose boxes are up to date.
  void cast_first_hits(OccupancyMap& map, const RunContext& context);
  /// Eqs 8-9 for both tests, where the scan has a return. It also looks the points' voxels up.
  void find_references(const StaticMap& map, const RunContext& context);
  /// Eq. 11, and the erase cases of Fig. 1: points in voxels that a scan saw through.
  [[nodiscard]] Mask find_candidates(const RunContext& context) const;
  /// Takes a scan and finds its points whose voxel is not in the map.
  [[nodiscard]] Mask find_off_map(Scan scan, const StaticMap& map, const RunContext& context);
  /// Eqs 12-15. It gives back the candidates themselves if they are not to be validated.
  [[nodiscard]] Mask validate(const Mask& candidates, const OccupancyMap& static_map) const;

  [[nodiscard]] const Scan& scan() const { return scan_; }
  [[nodiscard]] const AngularGrid& grid() const { return grid_; }
  [[nodiscard]] const ProjectedScan& projected() const { return projected_; }
  [[nodiscard]] const FirstHitImage& first_hit() const { return first_hit_; }
  /// d_map of the erase test.
  [[nodiscard]] const std::vector<float>& erase_reference() const { return references_.second; }
  /// The voxel of each point in the world lattice.
  [[nodiscard]] const std::vector<VoxelIndex>& voxels() const { return voxels_; }
  /// What the map knew of each point's voxel when it was looked up.
  [[nodiscard]] const VoxelLookup& known() const { return known_; }

 private:
  /// Whether what was seen through says something about the points that lie there.
  [[nodiscard]] bool erased_points_are_candidates() const;

  const Parameters& parameters_;
  AngularGrid grid_;
  FirstHitCaster caster_;
  Scan scan_;
  std::vector<VoxelIndex> voxels_;
  ProjectedScan projected_;
  FirstHitImage first_hit_;
  WindowPercentiles references_;
  VoxelLookup known_;
};

}  // namespace raymoval::raymoval_method
