// SPDX-License-Identifier: MIT
// FreeDOM written straight from its description with maps and sets: slow and plain. Step 3 is the
// method's own; its parts have tests of their own.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/freedom/maps.h"

namespace raymoval::freedom_test {

using namespace freedom_method;

using Cell = std::array<int, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    return VoxelKeyHash{}(voxel_key(cell[0], cell[1], cell[2]));
  }
};
using Cells = std::unordered_set<Cell, CellHash>;
template <class Value>
using CellMap = std::unordered_map<Cell, Value, CellHash>;

class Oracle {
 public:
  Oracle(const Parameters& parameters, const ScanSource& scans);

  [[nodiscard]] Mask mask(const Scan& scan) const;

 private:
  struct Seen {  ///< A voxel of a scan.
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int points = 0;
    Level level = Level::kStatic;
    Cells sub_voxels;
  };
  struct Space {
    int passes = 0, hits = 0;
    bool is_free = false;
  };
  struct Point {
    std::size_t scan = 0;
    Level level = Level::kEmpty;
  };
  using ScanVoxels = CellMap<Seen>;

  [[nodiscard]] static Cell cell_of(const Eigen::Vector3d& point, double size) {
    const Eigen::Vector3d v = point / size;
    return {floor_of(v.x()), floor_of(v.y()), floor_of(v.z())};
  }
  static int floor_of(double value) { return static_cast<int>(std::floor(value)); }
  [[nodiscard]] Cell block_of(const Cell& voxel) const;
  [[nodiscard]] Cell voxel_of(const Cell& sub_voxel) const;

  [[nodiscard]] ScanVoxels voxels_of(const Scan& scan) const;
  void count_hits(ScanVoxels& voxels);
  void revert(const Cell& voxel);
  void grow_in_scan(ScanVoxels& voxels) const;
  [[nodiscard]] Cells passed_by_rays(const Scan& scan, const ScanVoxels& voxels,
                                     const SensorModel& sensor) const;
  void follow(const Eigen::Vector3d& sensor, Eigen::Vector3d way, const ScanVoxels& voxels,
              Cells& passed) const;
  [[nodiscard]] bool is_full(const Cell& block) const;
  [[nodiscard]] Cells count_passes(const Cells& passed);
  void remove_from_map(const Cells& newly_free);
  void integrate(const ScanVoxels& voxels, std::size_t scan);

  Parameters p_;
  double voxel_;
  CellMap<Space> space_;
  Cells blocks_;           ///< In which any voxel was passed.
  CellMap<Point> points_;  ///< By sub-voxel.
};

}  // namespace raymoval::freedom_test
