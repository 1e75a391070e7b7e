// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/dynablox/block_map.h"
#include "methods/dynablox/range_image.h"
#include "methods/dynablox/voxel_kernels.h"
#include "methods/remover.h"

namespace raymoval::dynablox_method {

/// Step 8: takes scans into the distance field, as the nearest returns of a range image.
class Integrator {
 public:
  Integrator(const Parameters& parameters, const SensorModel& sensor);

  /// Makes the blocks along the rays of a scan where there are none, and updates their voxels as
  /// far as the image shows them.
  /// @param touched gets the blocks, in order of their indices
  void integrate(const Scan& scan, const RunContext& context, BlockMap& map,
                 std::vector<Block*>& touched);

  /// How far points and voxels take part, metres: not beyond the sensor's own range.
  [[nodiscard]] double max_range() const { return max_range_; }

 private:
  /// What all voxels have in common in the present scan.
  [[nodiscard]] kernels::Integration job() const;
  void touch_blocks(const Scan& scan, const RunContext& context, BlockMap& map,
                    std::vector<Block*>& touched) const;
  void update(const Scan& scan, const RunContext& context,
              const std::vector<Block*>& touched) const;

  Parameters parameters_;
  double max_range_;
  RangeImage image_;
  kernels::Kernels kernels_;
};

}  // namespace raymoval::dynablox_method
