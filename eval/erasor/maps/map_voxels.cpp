// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/map_voxels.h"

#include <utility>

#include "core/scan/scan_source.h"

namespace raymoval::erasor {
namespace {

CellLattice lattice_of(const std::vector<VoxelKey>& keys) {
  CellSet cells;
  for (const VoxelKey key : keys) cells.insert(key);
  return CellLattice(std::move(cells));
}

}  // namespace

VoxelKind kind_of(std::uint32_t word, const LabelClasses& classes) {
  if (classes.moving(word)) {
    return semantic_id(word) == kMovingTruck ? VoxelKind::kTruck : VoxelKind::kMoving;
  }
  return semantic_id(word) <= 1 ? VoxelKind::kUnlabelled : VoxelKind::kStatic;
}

ListedVoxels::ListedVoxels(const LabelledVoxels& voxels, const LabelClasses& classes)
    : cells_(lattice_of(voxels.keys)), means_(cells_.size()), kinds_(cells_.size()) {
  CellLattice::Cursor cursor;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const Number number = cells_.find(voxels.keys[i], cursor);
    means_[number] = voxels.cloud.points[i];
    kinds_[number] = kind_of(voxels.cloud.labels[i], classes);
  }
}

}  // namespace raymoval::erasor
