// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eval/erasor/maps/map_cells.h"
#include "eval/lattice/cell_means.h"
#include "eval/lattice/cells_in_reach.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval::erasor {

/// A point that a scan adds to the dense map, without its label.
struct DensePoint {
  CellLattice::Number cell;
  Eigen::Vector3d point;
};

/// The points that a scan adds to the dense map: for each cell the mean of its points.
/// @param points of the scan
/// @param scan its number, for messages
std::vector<DensePoint> dense_points(const std::vector<Eigen::Vector3d>& points,
                                     const MapRules& rules, const MapCells& cells, std::size_t scan,
                                     CellMeans& means);

/// The vote of a point of the dense map for a voxel near it.
struct Offer {
  std::uint32_t voter;  ///< Number of the voxel among the voting voxels.
  std::uint32_t word;   ///< Label of the point.
  double distance;      ///< From the voxel's mean, metres.
  bool moves;
};

/// Offers points of the dense map to the voxels in reach: a voxel's nearest point is never farther
/// from its mean than half a diagonal.
/// @param dense points of the dense map
/// @param voter_of the number of a cell's voxel among the voting voxels; `CellLattice::kNone` if it
/// has no vote
/// @param mean_of the mean of a voxel, by its number; not a number if there is none
template <class VoterOf, class MeanOf>
void add_offers(const LabelledCloud& dense, const MapRules& rules, const CellLattice& cells,
                VoterOf&& voter_of, MeanOf&& mean_of, std::vector<Offer>& offers) {
  const double size = rules.options.voxel_size;
  const double reach = std::sqrt(0.75) * size + 1e-6;  // More than rounding.
  const double bound = reach * reach;
  CellLattice::Cursor cursor;
  for (std::size_t i = 0; i < dense.size(); ++i) {
    const Eigen::Vector3d& point = dense.points[i];
    const bool moves = rules.classes.moving(dense.labels[i]);
    visit_cells_in_reach(point, size, bound, [&](VoxelKey cell) {
      const CellLattice::Number number = cells.find(cell, cursor);
      if (number == CellLattice::kNone) return;
      const std::uint32_t voter = voter_of(number);
      if (voter == CellLattice::kNone) return;
      const double squared = (point - mean_of(number)).squaredNorm();
      if (squared <= bound) offers.push_back({voter, dense.labels[i], std::sqrt(squared), moves});
    });
  }
}

}  // namespace raymoval::erasor
