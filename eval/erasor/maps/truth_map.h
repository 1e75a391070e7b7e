// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "eval/erasor/maps/map_cells.h"
#include "eval/erasor/maps/map_voxels.h"
#include "eval/lattice/mean_table.h"

namespace raymoval::erasor {

/// The map of all points of a sequence, bit for bit equal to `voxelise` of the dense map, but
/// without the dense map. No points are stored. The first pass over the scans finds the cells, the
/// second adds up the means of the voxels, and in the third the points of the dense map vote for
/// labels. Each pass computes the points of the dense map again. Building it takes about 60 bytes a
/// cell, keeping it 34.
class TruthMap : public MapVoxels {
 public:
  /// @throws DataError as `load_checked`, or beyond the lattice
  explicit TruthMap(const MapRules& rules);

  [[nodiscard]] const CellLattice& cells() const override { return map_cells_.all; }
  [[nodiscard]] Eigen::Vector3d mean(Number number) const override { return means_.mean(number); }
  [[nodiscard]] VoxelKind kind(Number number) const override {
    return static_cast<VoxelKind>(labels_[number].kind);
  }

  [[nodiscard]] const MapCells& map_cells() const { return map_cells_; }
  [[nodiscard]] const PointCounts& points() const { return points_; }
  [[nodiscard]] std::int64_t voxels() const { return voxels_; }
  /// Voxels labelled 0 or 1.
  [[nodiscard]] std::int64_t unlabelled_voxels() const { return unlabelled_voxels_; }
  [[nodiscard]] std::int64_t mixed_label_ties() const { return mixed_label_ties_; }
  /// The scan whose point gave a voxel its label.
  [[nodiscard]] std::uint32_t scan(Number number) const { return labels_[number].scan; }
  /// Bytes of memory.
  [[nodiscard]] std::size_t bytes() const;

 private:
  class Builder;
  /// The kind of a voxel, and the scan of the point that gave it its label; no sequence has 2^29
  /// scans.
  struct Label {
    std::uint32_t kind : 3 = static_cast<std::uint32_t>(VoxelKind::kNone);
    std::uint32_t scan : 29 = 0;
  };
  static_assert(sizeof(Label) == 4);

  MapCells map_cells_;
  MeanTable means_;
  std::vector<Label> labels_;
  PointCounts points_;
  std::int64_t voxels_ = 0, unlabelled_voxels_ = 0, mixed_label_ties_ = 0;
};

}  // namespace raymoval::erasor
