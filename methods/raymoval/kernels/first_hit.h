// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "methods/common/workspaces.h"
#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/first_hit_sweep.h"

namespace raymoval::raymoval_method {

/// A ray in the world frame (eq. 6): origin o = t, unit direction d = R u.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Rays hit only voxels that they enter at a distance within these limits, metres.
struct RayLimits {
  double minimum_range = 0.0;
  double maximum_range = 60.0;
};

/// The first hit of a ray in the map.
struct FirstHit {
  double range;  ///< Distance at which the ray enters the voxel, metres.
  VoxelIndex voxel;
};

/// Eq. 7: the first occupied voxel along `ray` that is entered at a distance within `limits`, if
/// there is one. Exact and slow: it uses double precision and does not accumulate planes. Voxels
/// are half open, [k, k + 1) cells per axis.
/// @param from voxels that the ray leaves before this distance are skipped, metres
std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, const RayLimits& limits,
                                 double from = 0.0);

/// First hits for every bin of a grid.
struct FirstHitImage {
  AngularGrid grid;
  Pose T_world_sensor = Pose::Identity();
  RayLimits limits;
  std::vector<float> range;  ///< r_cast of each bin, metres; infinite without a hit.

  /// Eqs 5-6: the ray of a bin.
  [[nodiscard]] Ray ray(int bin) const {
    return {T_world_sensor.translation(), T_world_sensor.linear() * grid.direction(bin)};
  }
  /// The voxel that a bin's ray hits, found exactly on the map that the image was cast on. No value
  /// if the range is infinite, or if the map has changed there.
  [[nodiscard]] std::optional<VoxelIndex> voxel(const OccupancyMap& map, int bin) const;
};

/// Eqs 4-7 for all bins at once: the image of the map from any pose.
///
/// A sweep over columns of bins instead of a walk along rays; see KERNELS.md. The result is that of
/// `cast_ray` rounded to float, except for rays that graze an edge or are within a face. It does
/// not depend on threads, on the instruction set or on the other wanted bins.
class FirstHitCaster {
 public:
  FirstHitCaster(const AngularGrid& grid, const RayLimits& limits);

  /// Casts the image from `T_world_sensor`. The boxes of changed bricks are updated.
  /// @param image replaced; its memory is used again
  void cast(OccupancyMap& map, const Pose& T_world_sensor, int threads, FirstHitImage& image) {
    cast(map, T_world_sensor, all_, threads, image);
  }
  /// The same for some bins only. The ranges of other bins are undefined.
  void cast(OccupancyMap& map, const Pose& T_world_sensor, const WantedBins& wanted, int threads,
            FirstHitImage& image);

 private:
  sweep::Frame start_frame(const OccupancyMap& map, const Pose& T_world_sensor);
  void sweep_image(const sweep::Frame& frame, int threads, float* range);

  AngularGrid grid_;
  RayLimits limits_;
  WantedBins all_;
  sweep::GridTables tables_;
  sweep::WallTables walls_;
  sweep::BrickList bricks_;
  std::vector<std::uint32_t> starts_, order_;
  std::vector<sweep::ColumnLists> lists_;
  Workspaces<sweep::Scratch> scratch_{[] { return std::make_unique<sweep::Scratch>(); }};
  std::uint64_t images_ = 0;
};

/// Casts one image with a caster of its own.
FirstHitImage cast_first_hits(OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, const RayLimits& limits, int threads);

}  // namespace raymoval::raymoval_method
