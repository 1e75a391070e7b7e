// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/dynablox/dynablox.h"
#include "methods/dynablox/voxel_kernels.h"
#include "methods/dynablox/voxels.h"
#include "methods/remover.h"

namespace raymoval::dynablox_method {

/// Step 7: the ever-free voxels.
class FreeSpace {
 public:
  explicit FreeSpace(const Parameters& parameters)
      : parameters_(parameters), kernels_(kernels::best_kernels()) {}

  /// Updates the ever-free voxels of blocks for a new scan, before it is integrated.
  /// @param touched the blocks that rays of the previous scan passed through
  /// @param hits the voxels in which the scan has points
  void update(const std::vector<Block*>& touched, const SparseBlocks<BlockBits>& hits,
              std::int32_t scan, const RunContext& context, BlockMap& map) const;

 private:
  /// Finds the settled voxels of a block.
  /// @param is_touched whether rays of the previous scan passed through it, so that its occupied
  /// voxels are updated
  /// @return the voxels to reset
  std::vector<VoxelIndex> sweep(const BlockBits* hit, bool is_touched, std::int32_t scan,
                                Block& block) const;
  void add_ever_free(const BlockMap& map, Block& block) const;

  Parameters parameters_;
  kernels::Kernels kernels_;
};

/// The spherical image of ranges around a sensor. Columns of equal width go around the full circle
/// from azimuth -pi. Rows go up; the first and the last are centred on the ends of the vertical
/// field of view.
struct ImageGrid {
  int columns = 2048, rows = 64;
  float columns_per_radian = 0.0F, rows_per_radian = 0.0F;
  float elevation_min = 0.0F;  ///< Of the centre of row 0, radians.
  float pixels_per_square_radian = 0.0F;

  /// Unknown or impossible values of the sensor model are replaced by the published ones.
  explicit ImageGrid(const SensorModel& sensor);

  /// A pixel of the stored image. The stored image has an empty row below and above, and repeats
  /// the first column after the last.
  [[nodiscard]] std::size_t stored(int column, int row) const {
    return static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(columns + 1) +
           static_cast<std::size_t>(column);
  }
};

/// Step 8: integrates scans into the distance field, as the nearest returns of a range image.
/// Returns beyond the range mark free space in blocks that nearer returns touch.
class Integrator {
 public:
  Integrator(const Parameters& parameters, const SensorModel& sensor);

  /// Makes missing blocks along the rays of a scan, and updates the voxels of the blocks that are
  /// in the image.
  /// @param touched gets the blocks, in order of their indices
  void integrate(const Scan& scan, const RunContext& context, BlockMap& map,
                 std::vector<Block*>& touched);

  /// The range within which voxels are updated, metres; at most the sensor's range.
  [[nodiscard]] double max_range() const { return max_range_; }

 private:
  void fill_image(const Scan& scan);
  void touch_blocks(const Scan& scan, const RunContext& context, BlockMap& map,
                    std::vector<Block*>& touched) const;
  void update(const Scan& scan, const RunContext& context,
              const std::vector<Block*>& touched) const;

  Parameters parameters_;
  double max_range_;
  kernels::Kernels kernels_;
  ImageGrid grid_;
  std::vector<float> image_;          ///< Ranges of the nearest returns, metres; 0 for none.
  std::vector<std::int32_t> pixels_;  ///< Of points, and
  std::vector<float> ranges_;         ///< their ranges.
};

}  // namespace raymoval::dynablox_method
