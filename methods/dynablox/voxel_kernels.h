// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Loops over the points of a scan and the voxels of a layer, compiled for each instruction set.
namespace raymoval::dynablox_method::kernels {

/// Coefficients, highest power first, of the odd polynomial with the smallest maximum error for the
/// arc tangent from 0 to 45 degrees. The error is below 4e-7.
inline constexpr float kArcTangentTerms[] = {-0.00405456219F, 0.0218629390F, -0.0559123009F,
                                             0.0964219570F,   -0.139086291F, 0.199465662F,
                                             -0.333298594F,   0.999999344F};

inline constexpr float kHalfTurn = 3.14159265358979F;
inline constexpr float kSeenWeight = 1e-6F;  ///< A voxel with at most this weight was not seen.

/// The projection of points into an image.
struct Projection {
  int columns = 0, rows = 0;
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F, elevation_min = 0.0F;
  float min_range = 0.0F;  ///< Nearer points are in no pixel.
};

/// Constants of all voxels for the integration of one scan.
struct Integration {
  const float* image = nullptr;  ///< As `ImageGrid` stores it.
  int columns = 0;
  float last_row = 0.0F;  ///< Voxels above it and below row 0 are not seen.
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F, elevation_min = 0.0F;
  float min_range = 0.0F, max_range = 0.0F;
  float rays_at_a_metre = 0.0F;  ///< Rays through a voxel: its weight.
  float voxel_size = 0.0F;
  float truncation = 0.0F, max_weight = 0.0F;
  /// From a voxel's centre to the next one's along x and y, sensor frame, metres.
  std::array<float, 3> along_x{}, along_y{};
};

/// A layer to integrate the scan into.
struct LayerFields {
  std::array<float, 3> first{};  ///< The centre of its first voxel in the sensor frame, metres.
  float* distance = nullptr;
  float* weight = nullptr;
};

/// Constants of all voxels for a sweep.
struct Sweep {
  float occupied_below = 0.0F;
  std::int32_t scan = 0;
  std::int32_t temporal_buffer = 0, burn_in = 0, frames_to_reset = 0;
};

/// A layer to sweep: its values, and bits of its rows.
struct SweptLayer {
  const float* distance = nullptr;
  const float* weight = nullptr;
  std::int32_t* last_occupied = nullptr;
  std::uint16_t* occupied_scans = nullptr;
  const std::uint16_t* hit = nullptr;  ///< Null where the scan has no point in the block.
  std::uint16_t* settled = nullptr;    ///< Output: the settled voxels.
  std::uint16_t* lasting = nullptr;    ///< Output: voxels occupied for long enough to be reset.
};

struct Kernels {
  std::size_t most_lanes;  ///< Largest number of points that `project` takes at a time.
  /// @param points x y z of each, a multiple of `most_lanes` of them
  /// @param pixel set to the index in the stored image (see `ImageGrid`), or -1
  void (*project)(const Projection& image, const float* points, std::size_t count,
                  std::int32_t* pixel, float* range);
  /// @return whether any voxel was updated
  bool (*integrate)(const Integration& scan, const LayerFields& layer);
  void (*sweep)(const Sweep& scan, const SweptLayer& layer);
  /// Only finds the settled voxels.
  void (*settle)(const Sweep& scan, const SweptLayer& layer);
};

/// The kernels for the best instruction set of this processor.
Kernels best_kernels();

}  // namespace raymoval::dynablox_method::kernels
