// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "methods/raymoval/kernels/angular_grid.h"
#include "methods/raymoval/kernels/occupancy_map.h"
#include "methods/raymoval/kernels/wanted_bins.h"

namespace raymoval::raymoval_method {

/// A ray in the world frame (eq. 6): origin o = t, unit direction d = R u.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

/// Rays hit only what they enter at a distance within these limits, metres.
struct RayLimits {
  double minimum_range = 0.0;
  double maximum_range = 60.0;
};

/// Where a ray first meets the map.
struct FirstHit {
  double range;  ///< Distance at which the ray enters the voxel, metres.
  VoxelIndex voxel;
};

/// Eq. 7: the first occupied voxel along `ray` that is entered at a distance within `limits`, if
/// there is one. Exact, and slow: in double, planes are never accumulated. Voxels are
/// half open, [k, k + 1) cells an axis.
/// @param from voxels that the ray leaves before this distance are skipped, metres
std::optional<FirstHit> cast_ray(const OccupancyMap& map, const Ray& ray, const RayLimits& limits,
                                 double from = 0.0);

/// First hits for every bin of a grid.
struct FirstHitImage {
  AngularGrid grid;
  Pose T_world_sensor = Pose::Identity();
  RayLimits limits;
  std::shared_ptr<const DirectionTable> directions;  ///< The directions of the grid's bins.
  std::vector<float> range;  ///< r_cast of each bin, metres; it is infinite where nothing is hit.

  /// Eqs 5-6: the ray of a bin.
  [[nodiscard]] Ray ray(int bin) const;
  /// The voxel that a bin's ray hits, found exactly on the map that the image was cast on.
  /// There is none if the range is infinite, or if the map has changed there.
  [[nodiscard]] std::optional<VoxelIndex> voxel(const OccupancyMap& map, int bin) const;
};

/// Eqs 4-7 for all bins at once: the image of the map from any pose.
///
/// **How.** A sweep over columns of bins instead of a walk along rays. Bricks of 8^3 voxels within
/// reach are sorted front to back into the columns of bins (one azimuth each) that see them. In a
/// column the rows are the lanes of vectors. A brick is skipped if no row is still open beyond its
/// distance; else those of its boxes (see box_cover.h) that the column's half plane crosses at the
/// rows' elevations are tested, exactly, against all rays of a vector at once: three products and a
/// maximum against three products and a minimum.
///
/// **Safe bounds.** A column's half plane is rho A + h B with B the sensor's up axis and A the
/// column's direction. A box has heights h0 .. h1 along B. Along each of the two world axes k that
/// are least upright, rho A_k lies within low_k - max(B_k h) .. high_k - min(B_k h), so the box is
/// crossed between rho_in and rho_out, the larger of the two entries and the smaller of the two
/// exits, and its elevations have tangents from h0 / rho to h1 / rho at the ends that are farthest
/// apart. All bounds are widened by `slack`; they decide what is tested and not the answer.
///
/// **Exactness.** Walls are subtracted from the sensor's position, and directions computed, in
/// double and then rounded to float once, so neighbouring boxes share their walls bit by bit and no
/// ray slips between them. Boxes that the sensor stands beside are cut at the sensor's planes: the
/// entry wall of each piece is then known. Rays that are inside a box at the minimum range are
/// tested with its voxels one by one. The answer is that of `cast_ray` rounded to float, but for
/// rays that graze an edge or lie within a face. It does not depend on threads or the instruction
/// set.
///
/// **What lost.** Milliseconds an image of 720 x 450 on one Zen 5 core, KITTI raw drive 0005, map
/// of its static points, 38 steps a ray, all in one run of November 2026: this 2.8 with AVX-512,
/// 3.6 with AVX2, 6.4 with SSE4, 56 without vectors; OctoMap's castRay 367; walks on a hash set
/// 191, on hashed bricks 156, on a dense block of bits 86; sixteen rays in lockstep on the dense
/// block 28; the dense walk for those directions only in which the scan has a return 17. Of these,
/// castRay and the walks on a hash set and on a dense block are still timed (scripts/benchmark.sh).
/// raymoval:online as a whole took 9.5 a scan with this and 139 with the dense walk.
/// Within this design: cutting boxes near the minimum range into voxels beforehand (3.0
/// against 2.5), casting the rays concerned one by one (5.6 against 2.5), and covering changed
/// bricks from scratch instead of mending their covers (upkeep 1.6 against 0.8 a scan; the image
/// takes the same time).
class FirstHitCaster {
 public:
  FirstHitCaster(const AngularGrid& grid, const RayLimits& limits);
  ~FirstHitCaster();
  FirstHitCaster(FirstHitCaster&&) noexcept;
  FirstHitCaster& operator=(FirstHitCaster&&) noexcept;

  /// Casts the image from `T_world_sensor`. The boxes of changed bricks are brought up to date.
  /// @param image replaced; its memory is used again
  void cast(OccupancyMap& map, const Pose& T_world_sensor, int threads, FirstHitImage& image);
  /// Does the part of the next cast from this pose that does not ask for bins, where there is time
  /// for it. The map must not change in between.
  void prepare(OccupancyMap& map, const Pose& T_world_sensor, int threads);
  /// The same for some bins only. The ranges of the other bins mean nothing.
  void cast(OccupancyMap& map, const Pose& T_world_sensor, const WantedBins& wanted, int threads,
            FirstHitImage& image);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Casts one image with a caster of its own.
FirstHitImage cast_first_hits(OccupancyMap& map, const Pose& T_world_sensor,
                              const AngularGrid& grid, const RayLimits& limits, int threads);

}  // namespace raymoval::raymoval_method
