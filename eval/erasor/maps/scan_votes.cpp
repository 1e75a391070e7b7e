// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/scan_votes.h"

#include "eval/checked_scan.h"

namespace raymoval::erasor {

std::vector<DensePoint> dense_points(const std::vector<Eigen::Vector3d>& points,
                                     const MapRules& rules, const MapCells& cells, std::size_t scan,
                                     CellMeans& means) {
  const double inverse = 1.0 / rules.options.voxel_size;
  means.compute(points, rules.options.voxel_size);
  std::vector<DensePoint> dense;
  dense.reserve(means.cells().size());
  CellLattice::Cursor cursor;
  bool in_own_cells = true;
  for (const CellMeans::Cell& cell : means.cells()) {
    const Eigen::Vector3d point = cell.mean.mean();
    const VoxelKey key = cell_key(point, inverse);
    const CellLattice::Number number = cells.all.find(key, cursor);
    if (number == CellLattice::kNone) throw_changed(rules.input, scan);
    in_own_cells = in_own_cells && key == cell.key;
    dense.push_back({cell.key, number, point});
  }
  if (!in_own_cells) {
    std::sort(dense.begin(), dense.end(),
              [](const DensePoint& a, const DensePoint& b) { return a.from < b.from; });
  }
  return dense;
}

}  // namespace raymoval::erasor
