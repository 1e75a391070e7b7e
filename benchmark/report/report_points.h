// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_set.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval {

/// The number of steps along the edge of a voxel. Positions of shown points are whole numbers of
/// steps.
inline constexpr int kStepsPerVoxel = 16;

/// A point that may be shown.
struct ShownPoint {
  std::array<std::int32_t, 3> step;  ///< Position in steps, rounded down.
  std::uint32_t scan = 0;
  std::uint16_t label = 0;  ///< Semantic id.
};

/// Keeps points up to a limit. If more come, it divides space into cells and keeps the first point
/// of each cell; the cells grow until the limit holds. The same points in the same order always
/// leave the same ones.
class ReportPoints {
 public:
  /// @param verdicts how many bytes stand beside each point
  /// @param cell the first size of a cell in steps. If 0, every point stays as long as there is
  /// room
  ReportPoints(std::size_t limit, std::size_t verdicts, int cell)
      : limit_(limit), verdicts_(verdicts), cell_(cell) {}

  /// @param group points thin out only points of the same group
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
