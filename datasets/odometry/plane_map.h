// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"
#include "datasets/registration/plane_step.h"

namespace raymoval::odometry {

/// A map of planes: cubic cells of three sizes, each twice as large as the one before. A cell
/// whose points lie on a plane has that plane (voxel map of Yuan et al. 2022, with fixed cells).
/// Other cells of the smallest size, such as of plants and poles, have single points.
/// Cells with points of moving objects have no plane, or a plane that later scans do not meet.
class PlaneMap {
 public:
  static constexpr int kLevels = 3;
  static constexpr std::uint32_t kSingles = 6;  ///< Points that a cell without a plane keeps.
  static constexpr double kRoughWeight = 0.1;   ///< Of a match with a single point.
  /// @param cell_m edge of the smallest cells, metres
  explicit PlaneMap(double cell_m);

  /// @param points in the frame of a sensor
  /// @param T_map_sensor of that sensor
  void add(const std::vector<Eigen::Vector3f>& points, const Pose& T_map_sensor = Pose::Identity());
  /// Removes the cells farther than `radius` from `centre`, metres.
  void forget_beyond(const Eigen::Vector3d& centre, double radius);

  /// The planes below points, in the smallest cells that have one. Planes of narrow strips, such as
  /// of one ring, have less weight, but more than `kRoughWeight`. A point in a cell without a plane
  /// has three matches, with the nearest point along each axis, and that weight.
  /// @param points in the frame of a sensor
  /// @param T_map_sensor of that sensor
  /// @param reach largest distance from a plane, metres. Only cells of at least this size are used.
  [[nodiscard]] registration::Matches match(const std::vector<Eigen::Vector3f>& points,
                                            const Pose& T_map_sensor, double reach) const;
  /// The points that are in cells without a plane, and not among too few points for one.
  [[nodiscard]] std::vector<Eigen::Vector3f> rough(
      const std::vector<Eigen::Vector3f>& points) const;
  /// Mean closeness of points to the nearest points of cells without a plane: 1 for a distance of
  /// 0, 0 from `reach` on (at most half a cell).
  [[nodiscard]] double closeness(const std::vector<Eigen::Vector3f>& points,
                                 const Pose& T_map_sensor, double reach) const;
  [[nodiscard]] std::size_t size() const { return levels_[0].cells.size(); }
  [[nodiscard]] double cell() const { return cell_m_; }

 private:
  struct Cell {
    VoxelKey key = 0;
    std::uint32_t count = 0, fitted = 0;  ///< Points; points at the last fit.
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::array<float, 6> products{};  ///< Sums of xx, xy, xz, yy, yz, zz, from the cell's centre.
    Eigen::Vector3f mean = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    float weight = 1.0F;    ///< Of the plane: how much of the cell's width its points fill.
    bool is_rough = false;  ///< Thick, so that it has no plane.
    std::uint32_t singles = 0;
    std::array<Eigen::Vector3f, kSingles> points;  ///< From the cell's centre.
  };
  struct Level {
    double cell_m = 1.0;
    std::vector<Cell> cells;
    VoxelMap<std::uint32_t> numbers;  ///< By key.
    [[nodiscard]] const Cell* find(const Eigen::Vector3d& at) const;
  };
  /// The vector to the nearest single point from `at`; empty if there is none within half a cell.
  [[nodiscard]] std::optional<Eigen::Vector3d> to_nearest(const Eigen::Vector3d& at,
                                                          double reach) const;
  static void add(Level& level, const std::vector<Eigen::Vector3d>& points);
  static void fit(Cell& cell, double cell_m);
  static Eigen::Vector3d centre_of(const Cell& cell, double cell_m);

  double cell_m_;
  std::array<Level, kLevels> levels_;
};

}  // namespace raymoval::odometry
