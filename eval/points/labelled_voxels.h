// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/label_rule.h"
#include "core/scan/voxel_key.h"

namespace raymoval {

/// Distances that differ by at most this many metres count as equal when a point takes the label of
/// its nearest point. Then the point with the lowest input index gives the label.
inline constexpr double kLabelTieMargin = 1e-9;

/// Points of the world frame (metres), each with its label word.
struct LabelledCloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> labels;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  void append(const LabelledCloud& other);
};

/// Mean of points that are added one by one, summed as offsets from the first one, so that it is as
/// exact far from the origin as near it. The same points in the same order give the same bits.
struct OffsetMean {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< Of the offsets of all points but the first.
  std::uint32_t points = 0;

  void add(const Eigen::Vector3d& point) {
    if (points++ == 0) {
      first = point;
    } else {
      sum += point - first;
    }
  }
  /// @return not a number without points
  [[nodiscard]] Eigen::Vector3d mean() const { return first + sum / static_cast<double>(points); }
};

/// Occupied cells of a lattice anchored at the world origin, in the order of their keys (x runs
/// fastest, then y, then z).
struct LabelledVoxels {
  std::vector<VoxelKey> keys;
  LabelledCloud cloud;  ///< Centroid and label of each cell.
  /// Input point that gave each cell its label.
  std::vector<std::uint32_t> label_points;
  /// Cells whose label was decided by input order between a moving and a static point.
  std::int64_t mixed_label_ties = 0;

  [[nodiscard]] std::size_t size() const { return keys.size(); }
};

/// A label rule as a table, for a fast look-up of the class of a semantic id.
class LabelClasses {
 public:
  explicit LabelClasses(const LabelRule& rule);
  [[nodiscard]] LabelClass of(std::uint32_t word) const { return table_[word & 0xFFFFU]; }
  [[nodiscard]] bool moving(std::uint32_t word) const { return of(word) == LabelClass::kMoving; }

 private:
  std::vector<LabelClass> table_;
};

/// Label-preserving voxelisation: one point per occupied cell, the centroid of the cell's points
/// (first point plus the mean offset from it, in double), which takes the label of its nearest
/// point in the whole of `cloud`. Among points within `kLabelTieMargin` of the nearest the one with
/// the lowest index gives the label.
/// @param voxel_size edge of a cell in metres
/// @param classes define which ties are mixed, and change nothing else
/// @throws DataError if a point lies beyond the lattice or there are 2^32 points or more
/// Source: ERASOR's public evaluation, which uses a voxel grid filter and a 1-NN search.
LabelledVoxels voxelise(const LabelledCloud& cloud, double voxel_size, const LabelClasses& classes,
                        int threads);

}  // namespace raymoval
