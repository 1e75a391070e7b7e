// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eval/lattice/cell_lattice.h"
#include "eval/points/labelled_voxels.h"

namespace raymoval::erasor {

/// Semantic id of the trucks that early published tables count as static.
inline constexpr std::uint16_t kMovingTruck = 258;

/// The kind of a voxel, by its label.
enum class VoxelKind : std::uint8_t {
  kNone,  ///< There is no voxel.
  kStatic,
  kUnlabelled,  ///< Static, labelled 0 or 1.
  kMoving,
  kTruck  ///< It moves, but not in tables that count id 258 as static.
};

VoxelKind kind_of(std::uint32_t word, const LabelClasses& classes);

/// The voxels of a map, by the numbers of a lattice. Not every cell of the lattice has a voxel.
class MapVoxels {
 public:
  using Number = CellLattice::Number;

  virtual ~MapVoxels() = default;
  [[nodiscard]] virtual const CellLattice& cells() const = 0;
  /// The centroid, world frame; not a number if there is no voxel.
  [[nodiscard]] virtual Eigen::Vector3d mean(Number number) const = 0;
  [[nodiscard]] virtual VoxelKind kind(Number number) const = 0;
};

inline bool is_voxel(const Eigen::Vector3d& mean) {
  return !std::isnan(mean.x());
}

/// A map whose voxels were found elsewhere.
class ListedVoxels : public MapVoxels {
 public:
  ListedVoxels(const LabelledVoxels& voxels, const LabelClasses& classes);
  [[nodiscard]] const CellLattice& cells() const override { return cells_; }
  [[nodiscard]] Eigen::Vector3d mean(Number number) const override { return means_[number]; }
  [[nodiscard]] VoxelKind kind(Number number) const override { return kinds_[number]; }

 private:
  CellLattice cells_;
  std::vector<Eigen::Vector3d> means_;
  std::vector<VoxelKind> kinds_;
};

}  // namespace raymoval::erasor
