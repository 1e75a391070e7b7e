// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/scan/scan.h"

/// The loops that take a scan's points to the world. They are compiled for each instruction set,
/// and all give the same numbers: those of `T_world_sensor * point` in double precision.
namespace raymoval::raymoval_plus_method::kernels {

/// Some points of a scan, and what takes them to cells of the world.
struct PointsToCells {
  const float* points = nullptr;  ///< x y z, x y z, ... in the sensor frame, metres.
  std::size_t count = 0;
  std::array<double, 9> rotation{};  ///< To the world frame, row by row.
  std::array<double, 3> translation{};
  std::array<double, 3> cells_a_metre{};
  double limit = 0.0;  ///< The largest magnitude of a cell's index.
};

/// Arrays of `count` numbers, one for each point.
struct PointCells {
  std::int32_t *x = nullptr, *y = nullptr, *z = nullptr;
  /// Where the point is in its cell: 256 parts along each axis, in bytes, those of x lowest. May be
  /// null.
  std::uint32_t* parts = nullptr;
  float* height = nullptr;  ///< The z of the world point, metres. May be null.
};

struct PointKernels {
  /// @return false if a cell is beyond the limit, or a point is not finite; cells are then wrong
  bool (*find_cells)(const PointsToCells& job, const PointCells& cells);
};

/// The kernels for the best instruction set that this processor has.
PointKernels best_point_kernels();

}  // namespace raymoval::raymoval_plus_method::kernels
