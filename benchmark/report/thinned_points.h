// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_set.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// Steps of a shown point's position in a voxel: positions are whole numbers of them.
inline constexpr int kStepsPerVoxel = 16;

/// A point that may be shown.
struct ShownPoint {
  std::array<std::int32_t, 3> step;  ///< Position in steps, rounded down.
  std::uint32_t scan = 0;
  std::uint16_t label = 0;  ///< Semantic id.
};

/// Points up to a limit. Where more come, space is divided into cells and the first point of each
/// cell stays; cells grow until the limit holds. What came first decides, so the same points in the
/// same order leave the same ones.
class ThinnedPoints {
 public:
  /// @param verdicts bytes beside each point
  /// @param cell first size of a cell in steps; 0: every point stays as long as there is room
  ThinnedPoints(std::size_t limit, std::size_t verdicts, int cell)
      : limit_(limit), verdicts_(verdicts), cell_(cell) {}

  /// @param group only points of one group are thinned among each other
  void add(const ShownPoint& point, std::uint64_t group, std::span<const std::uint8_t> verdict);
  /// Thins to `limit` or fewer.
  void reduce(std::size_t limit);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] int cell() const { return cell_; }
  [[nodiscard]] const std::vector<ShownPoint>& points() const { return points_; }
  /// The bytes of point `i`.
  [[nodiscard]] std::span<const std::uint8_t> verdict(std::size_t i) const {
    return {bytes_.data() + i * verdicts_, verdicts_};
  }

 private:
  [[nodiscard]] std::uint64_t key(const ShownPoint& point, std::uint64_t group) const;
  void grow_cells();

  std::size_t limit_, verdicts_;
  int cell_;
  std::vector<ShownPoint> points_;
  std::vector<std::uint64_t> groups_;
  std::vector<std::uint8_t> bytes_;
  tsl::robin_set<std::uint64_t, VoxelKeyHash> taken_;
};

}  // namespace raymoval
