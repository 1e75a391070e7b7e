// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/voxel_key.h"

namespace raymoval {

/// Points of the world frame (metres) that can be asked for all that lie within one fixed reach of
/// a query. A hash of cells of four times the reach, so that a query looks into 1 to 8 of them.
/// @tparam Point Eigen::Vector3d, or Eigen::Vector3f for half the memory; distances are in double
template <class Point>
class NearbyPoints {
 public:
  /// @param reach metres
  /// @throws DataError if a point lies beyond the lattice or there are 2^32 points or more
  NearbyPoints(const std::vector<Point>& points, double reach);

  /// Calls `visit(position in points)` for every point whose squared distance (in double) from
  /// `query` is at most `reach` squared, in no particular order, until it returns false.
  template <class Visit>
  void visit(const Eigen::Vector3d& query, Visit&& visit) const {
    if (points_.empty()) return;
    // A nanometre more covers rounding; the distance itself decides.
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(reach_ + 1e-9);
    const VoxelIndex low = voxel_index(query - margin, inverse_edge_);
    const VoxelIndex high = voxel_index(query + margin, inverse_edge_);
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          if (!visit_cell(voxel_key(x, y, z), query, visit)) return;
        }
      }
    }
  }

  [[nodiscard]] bool has_near(const Eigen::Vector3d& query) const {
    bool found = false;
    visit(query, [&](std::uint32_t) {
      found = true;
      return false;
    });
    return found;
  }

 private:
  struct Span {
    std::uint32_t begin, end;
  };
  struct Entry {
    Point point;
    std::uint32_t index;
  };

  template <class Visit>
  bool visit_cell(VoxelKey key, const Eigen::Vector3d& query, Visit&& visit) const {
    const auto found = cells_.find(key);
    if (found == cells_.end()) return true;
    const Span span = found->second;
    for (std::uint32_t i = span.begin; i < span.end; ++i) {
      const Entry& entry = points_[i];
      if ((entry.point.template cast<double>() - query).squaredNorm() > reach_ * reach_) continue;
      if (!visit(entry.index)) return false;
    }
    return true;
  }

  double reach_;
  double inverse_edge_;
  std::vector<Entry> points_;  ///< Cell by cell.
  VoxelMap<Span> cells_;
};

extern template class NearbyPoints<Eigen::Vector3d>;
extern template class NearbyPoints<Eigen::Vector3f>;

}  // namespace raymoval
