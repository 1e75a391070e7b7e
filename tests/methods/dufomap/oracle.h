// SPDX-License-Identifier: MIT
// DUFOMap written straight from its five steps with plain sets: slow and plain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/scan/scan_source.h"
#include "methods/dufomap/dufomap.h"

namespace raymoval::dufomap_test {

using namespace dufomap_method;

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;

struct ScanSets {
  Cells hit, free, voids;
};

class Oracle {
 public:
  explicit Oracle(const Parameters& parameters) : parameters_(parameters) {}

  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& world) const {
    const Eigen::Vector3d v = world / parameters_.voxel_size;
    return {floor_of(v.x()), floor_of(v.y()), floor_of(v.z())};
  }

  /// Steps 1-4.
  [[nodiscard]] ScanSets sets_of(const Scan& scan) const {
    ScanSets sets;
    Cells ends;  // Step 1.
    for (const auto& point : scan.points) {
      if (point.cast<double>().norm() < parameters_.minimum_range) continue;
      ends.insert(cell_of(scan.T_world_sensor * point.cast<double>()));
    }
    const Eigen::Vector3d sensor = scan.T_world_sensor.translation() / parameters_.voxel_size;
    for (const Cell& end : ends) add_hits(sensor, end, sets);
    for (const Cell& end : ends) add_free(sensor, end, sets);
    for (const Cell& cell : sets.free) {
      if (is_void(cell, sets)) sets.voids.insert(cell);
    }
    return sets;
  }

  /// Step 5 for every scan, from all scans or from scans 0 .. t.
  [[nodiscard]] std::vector<Mask> masks(const ScanSource& scans) const {
    Cells voids;
    std::vector<Mask> masks;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const ScanSets sets = sets_of(scans.load(i));
      voids.insert(sets.voids.begin(), sets.voids.end());
      if (!parameters_.offline) masks.push_back(mask_of(scans.load(i), voids));
    }
    for (std::size_t i = 0; parameters_.offline && i < scans.size(); ++i) {
      masks.push_back(mask_of(scans.load(i), voids));
    }
    return masks;
  }

 private:
  struct Crossing {
    double distance;
    int axis;
    bool operator<(const Crossing& other) const {
      return std::tie(distance, axis) < std::tie(other.distance, other.axis);
    }
  };

  static int floor_of(double value) { return static_cast<int>(std::floor(value)); }
  static Eigen::Vector3d middle(const Cell& cell) {
    return {cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5};
  }

  /// All walls that a line crosses within `length`, in order.
  static std::vector<Crossing> crossings(const Eigen::Vector3d& from, const Eigen::Vector3d& u,
                                         double length) {
    std::vector<Crossing> all;
    for (int axis = 0; axis < 3; ++axis) {
      if (u[axis] == 0.0) continue;
      const int first = floor_of(from[axis]);
      for (int n = 0;; ++n) {
        const double wall = u[axis] > 0.0 ? first + 1 + n : first - n;
        const double distance = (wall - from[axis]) / u[axis];
        if (distance >= length) break;
        all.push_back({distance, axis});
      }
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  /// Step 2.
  void add_hits(const Eigen::Vector3d& sensor, const Cell& end, ScanSets& sets) const {
    const Eigen::Vector3d u = (middle(end) - sensor).normalized();
    const double reach = parameters_.hit_extension / parameters_.voxel_size;
    const Eigen::Vector3d from = middle(end) - reach * u;
    Cell cell{floor_of(from.x()), floor_of(from.y()), floor_of(from.z())};
    sets.hit.insert(cell);
    for (const Crossing& crossing : crossings(from, u, reach)) {
      step(cell, crossing.axis, u);
      sets.hit.insert(cell);
    }
  }

  /// Step 3.
  void add_free(const Eigen::Vector3d& sensor, const Cell& end, ScanSets& sets) const {
    const Eigen::Vector3d u = (middle(end) - sensor).normalized();
    double length = (middle(end) - sensor).norm();
    if (parameters_.maximum_range > 0.0) {
      length = std::min(length, parameters_.maximum_range / parameters_.voxel_size);
    }
    const std::vector<Crossing> walls = crossings(sensor, u, length + 40.0);
    Cell cell{floor_of(sensor.x()), floor_of(sensor.y()), floor_of(sensor.z())};
    sets.free.insert(cell);
    std::size_t next = 0;
    while (walls[next].distance < length && sets.hit.count(cell) == 0) {
      step(cell, walls[next++].axis, u);
      sets.free.insert(cell);
    }
    if (!parameters_.compensate_inflation) return;
    const Cell last = cell;
    int axis = 0;
    while (std::abs(cell[static_cast<std::size_t>(axis)] - last[static_cast<std::size_t>(axis)]) !=
           parameters_.unknown_inflation) {
      axis = walls[next++].axis;
      step(cell, axis, u);
      sets.free.insert(cell);
    }
  }

  /// Step 4.
  [[nodiscard]] bool is_void(const Cell& cell, const ScanSets& sets) const {
    if (sets.hit.count(cell) != 0) return false;
    const int d = parameters_.unknown_inflation;
    for (int x = -d; x <= d; ++x) {
      for (int y = -d; y <= d; ++y) {
        for (int z = -d; z <= d; ++z) {
          if (sets.free.count({cell[0] + x, cell[1] + y, cell[2] + z}) == 0) return false;
        }
      }
    }
    return true;
  }

  [[nodiscard]] Mask mask_of(const Scan& scan, const Cells& voids) const {
    Mask mask;
    for (const auto& point : scan.points) {
      mask.push_back(voids.count(cell_of(scan.T_world_sensor * point.cast<double>())) != 0);
    }
    return mask;
  }

  static void step(Cell& cell, int axis, const Eigen::Vector3d& u) {
    cell[static_cast<std::size_t>(axis)] += u[axis] > 0.0 ? 1 : -1;
  }

  Parameters parameters_;
};

/// Centre of a voxel of 0.1 m.
inline Eigen::Vector3d centre(int x, int y, int z) {
  return Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) * 0.1;
}

}  // namespace raymoval::dufomap_test
