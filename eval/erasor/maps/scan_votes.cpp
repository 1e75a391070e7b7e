// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/scan_votes.h"

#include "eval/checked_scan.h"

namespace raymoval::erasor {

std::vector<DensePoint> dense_points(const std::vector<Eigen::Vector3d>& points,
                                     const MapRules& rules, const MapCells& cells, std::size_t scan,
                                     CellMeans& means) {
  means.compute(points, rules.options.voxel_size);
  std::vector<DensePoint> dense;
  dense.reserve(means.cells().size());
  CellLattice::Cursor cursor;
  for (const CellMeans::Cell& cell : means.cells()) {
    const CellLattice::Number number = cells.all.find(cell.key, cursor);
    if (number == CellLattice::kNone) throw_changed(rules.input, scan);
    dense.push_back({number, cell.mean.mean()});
  }
  return dense;
}

}  // namespace raymoval::erasor
