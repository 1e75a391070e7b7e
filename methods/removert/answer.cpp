// SPDX-License-Identifier: MIT
#include "methods/removert/answer.h"

#include <cmath>
#include <limits>

namespace raymoval::removert_method {
namespace {

/// Calls `visit(cell key, world position)` for each point of a thinned map.
template <class Visit>
void for_each_cell(const CellLattice& lattice, const MapPoints& points, Visit&& visit) {
  for (const Block& block : points.blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      visit(voxel_key(lattice.cell_index(block.key, points.id[i])), points.position(block, i));
    }
  }
}

class CellAnswer : public Answer {
 public:
  CellAnswer(const CellLattice& lattice, const MapPoints& removed) : lattice_(lattice) {
    removed_.reserve(removed.size());
    for_each_cell(lattice, removed,
                  [&](VoxelKey key, const Eigen::Vector3d&) { removed_.insert(key); });
  }
  [[nodiscard]] Mask of(const Scan& scan, std::uint64_t) const override {
    Mask mask(scan.size());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const auto place = lattice_.place_of(scan.T_world_sensor * scan.points[i].cast<double>());
      mask[i] = removed_.contains(voxel_key(place.index)) ? 1 : 0;
    }
    return mask;
  }

 private:
  const CellLattice& lattice_;
  VoxelSet removed_;
};

/// Answers for points some of which are in no cell of the map. It holds every cell's centroid.
class NearCellAnswer : public Answer {
 public:
  NearCellAnswer(const CellLattice& lattice, const MapPoints& kept, const MapPoints& removed)
      : lattice_(lattice) {
    cells_.reserve(kept.size() + removed.size());
    add(kept, false);
    add(removed, true);
  }
  [[nodiscard]] Mask of(const Scan& scan, std::uint64_t) const override {
    Mask mask(scan.size());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      mask[i] = is_removed(scan.T_world_sensor * scan.points[i].cast<double>()) ? 1 : 0;
    }
    return mask;
  }

 private:
  struct Cell {
    float x = 0.0F, y = 0.0F, z = 0.0F;  ///< Centroid from the cell's centre, metres.
    bool removed = false;
  };
  void add(const MapPoints& points, bool removed) {
    for_each_cell(lattice_, points, [&](VoxelKey key, const Eigen::Vector3d& at) {
      const Eigen::Vector3d centre = lattice_.cell_centre(voxel_index(key));
      const Eigen::Vector3f offset = (at - centre).cast<float>();
      cells_[key] = {offset.x(), offset.y(), offset.z(), removed};
    });
  }
  [[nodiscard]] bool is_removed(const Eigen::Vector3d& point) const {
    const VoxelIndex index = lattice_.place_of(point).index;
    if (const auto own = cells_.find(voxel_key(index)); own != cells_.end()) {
      return own->second.removed;
    }
    double nearest = 0.75 * lattice_.voxel() * lattice_.voxel();  // (sqrt(3) / 2 voxel)^2
    bool removed = false;
    for (int k = 0; k < 27; ++k) {
      const VoxelIndex other = index + VoxelIndex(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const auto found = cells_.find(voxel_key(other));
      if (found == cells_.end()) continue;
      const Cell& cell = found->second;
      const Eigen::Vector3d centroid =
          lattice_.cell_centre(other) + Eigen::Vector3d(cell.x, cell.y, cell.z);
      const double square = (centroid - point).squaredNorm();
      if (square < nearest) {
        nearest = square;
        removed = cell.removed;
      }
    }
    return removed;
  }

  const CellLattice& lattice_;
  VoxelMap<Cell> cells_;
};

class PointAnswer : public Answer {
 public:
  PointAnswer(const MapPoints& kept, const MapPoints& removed)
      : removed_(kept.size() + removed.size(), false) {
    for (const std::uint32_t id : removed.id) removed_[id] = true;
  }
  [[nodiscard]] Mask of(const Scan& scan, std::uint64_t first_number) const override {
    Mask mask(scan.size());
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = removed_[first_number + i] ? 1 : 0;
    return mask;
  }

 private:
  std::vector<bool> removed_;
};

}  // namespace

std::unique_ptr<Answer> answer_by_cell(const CellLattice& lattice, const MapPoints& kept,
                                       const MapPoints& removed, bool all_points_in_map) {
  if (!lattice.merges()) return std::make_unique<PointAnswer>(kept, removed);
  if (all_points_in_map) return std::make_unique<CellAnswer>(lattice, removed);
  return std::make_unique<NearCellAnswer>(lattice, kept, removed);
}

}  // namespace raymoval::removert_method
