// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "core/scan/sensor_model.h"
#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/first_hit.h"
#include "methods/raymoval/kernels/voxel_runs.h"
#include "methods/raymoval/map_reference.h"
#include "methods/raymoval/raymoval.h"
#include "methods/raymoval/static_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_method {

/// The grid of directions for `parameters` and this sensor (eq. 2).
AngularGrid grid_for(const SensorModel& sensor, const Parameters& parameters);

/// The tests that need a map reference.
enum class Tests {
  kBoth,
  kForward,  ///< Eq. 11: the scan is in front of the map.
  kErase,    ///< The scan sees through the map.
};

/// One scan against a map: the steps of section 3 in order; each needs the earlier steps. It keeps
/// its memory from scan to scan; each thread needs its own object.
/// @note all scans must be compared with the same map, which may change between them
class ScanAgainstMap {
 public:
  /// @param parameters must outlive this
  ScanAgainstMap(const Parameters& parameters, const SensorModel& sensor);

  /// Eqs 1-3 and 10. It also finds the voxel of each point.
  void project_scan(Scan scan, const RunContext& context) {
    project_next(std::move(scan), context);
    take_next();
  }
  /// The same for the next scan. The data of the current scan is not changed until `take_next`.
  void project_next(Scan scan, const RunContext& context);
  /// Makes the next scan the current one.
  void take_next() { std::swap(at_hand_, next_); }
  /// Eqs 4-7. It does not change a map whose boxes are up to date.
  void cast_first_hits(OccupancyMap& map, const RunContext& context);
  /// Eqs 8-9 where the scan has a return, for `tests`. It also looks up the points' voxels.
  void find_references(const StaticMap& map, const RunContext& context, Tests tests = Tests::kBoth);
  /// Eq. 11, and the erase cases of Fig. 1: points in voxels that a scan saw through.
  [[nodiscard]] Mask find_candidates(const RunContext& context) const;
  /// Eqs 12-15. It returns the candidates themselves without `Parameters::validate`.
  [[nodiscard]] Mask validate(const Mask& candidates, const OccupancyMap& static_map,
                              const RunContext& context) const;

  [[nodiscard]] const Scan& scan() const { return at_hand_.scan; }
  [[nodiscard]] const AngularGrid& grid() const { return grid_; }
  [[nodiscard]] const ProjectedScan& projected() const { return at_hand_.projected; }
  [[nodiscard]] const FirstHitImage& first_hit() const { return first_hit_; }
  /// d_map of the erase test.
  [[nodiscard]] const std::vector<float>& erase_reference() const { return references_.second; }
  /// The voxels of the points in the world lattice.
  [[nodiscard]] const VoxelRuns& voxels() const { return at_hand_.voxels; }
  /// The state of the voxel of each run of points when it was looked up.
  [[nodiscard]] const VoxelLookup& known() const { return known_; }

 private:
  /// The data of a scan that does not depend on the map.
  struct ScanInGrid {
    Scan scan;
    VoxelRuns voxels;
    ProjectedScan projected;
    WantedBins wanted;  ///< The bins of first hits that the steps below need.
  };
  const Parameters& parameters_;
  AngularGrid grid_;
  FirstHitCaster caster_;
  ScanInGrid at_hand_, next_;
  FirstHitImage first_hit_;
  WindowPercentiles references_;
  VoxelLookup known_;
};

}  // namespace raymoval::raymoval_method
