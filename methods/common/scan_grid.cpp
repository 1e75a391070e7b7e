// SPDX-License-Identifier: MIT
#include "methods/common/scan_grid.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval::scan_grid {

ScanBlock& ScanGrid::add_block(const VoxelIndex& at, VoxelKey key) {
  if (used_ >= kMostBlocks) {
    throw DataError("the beams of one scan cross more than " +
                    grouped_text(kMostBlocks * kSide * kSide * kHeight) +
                    " voxels; expected points within reach of a LiDAR. " + remedy_);
  }
  index_.emplace(key, static_cast<std::uint32_t>(used_));
  if (used_ == blocks_.size()) blocks_.push_back(std::make_unique<ScanBlock>());
  ScanBlock& block = *blocks_[used_++];
  block.at = at;
  block.beside = {};
  block.columns.fill(Column{});
  return block;
}

}  // namespace raymoval::scan_grid
