// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "methods/beautymap/column_map.h"

namespace raymoval::beautymap_method {

/// The columns around the sensor of one scan, with what the scan has in them.
class ScanWindow {
 public:
  /// @param placed where the scan's points are in the map
  ScanWindow(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
             const std::vector<PlacedPoint>& placed);

  /// One column of the window.
  struct Cell {
    std::uint32_t column = ColumnMap::kNone;     ///< Number in the map.
    std::uint32_t seen = 0;                      ///< Bit i: the scan has points in slice i.
    bool has_lower = false, has_higher = false;  ///< Points in a slice up to the top one, or above.
  };

  /// Whether none of the scan's points is in the window.
  [[nodiscard]] bool is_empty() const { return is_empty_; }
  [[nodiscard]] int side() const { return side_; }      ///< Columns.
  [[nodiscard]] int center() const { return center_; }  ///< The sensor's column, in x and in y.
  [[nodiscard]] const Cell& at(int x, int y) const { return cells_[number(x, y)]; }
  /// The foot of a column of the window, metres; where the map has none, the map's lowest point.
  [[nodiscard]] double foot(int x, int y) const;
  /// The foot of the sensor's own column, or what stands for it, metres.
  [[nodiscard]] double center_foot() const { return center_foot_; }
  [[nodiscard]] double sensor_z() const { return sensor_.z(); }  ///< Metres.
  /// The steepest ray upward that returned, metres of height for each metre of way.
  [[nodiscard]] double steepest() const { return steepest_; }

 private:
  [[nodiscard]] std::size_t number(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(y);
  }
  void place(const Parameters& parameters);
  void find_columns();
  void enter(const Parameters& parameters, const std::vector<PlacedPoint>& placed);
  void find_steepest(const Scan& scan);
  [[nodiscard]] double foot_around(const Parameters& parameters) const;

  const ColumnMap& map_;
  Eigen::Vector3d sensor_;
  ColumnIndex first_;  ///< The column (0, 0) of the window.
  int side_ = 0, center_ = 0;
  double center_foot_ = 0.0, steepest_ = 0.0;
  bool is_empty_ = true;
  std::vector<Cell> cells_;
};

}  // namespace raymoval::beautymap_method
