// SPDX-License-Identifier: MIT
#include "tests/methods/freedom/oracle.h"

#include <cmath>
#include <functional>

#include "methods/freedom/depth_image.h"

namespace raymoval::freedom_test {
namespace {

/// The 26 neighbours of a voxel.
std::vector<Cell> around(const Cell& cell) {
  std::vector<Cell> cells;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) cells.push_back({cell[0] + x, cell[1] + y, cell[2] + z});
      }
    }
  }
  return cells;
}

/// Steps 2 and 5 grow alike. `take(cell, level)` says whether a cell takes the level.
void grow(const std::vector<Level>& levels, Cells frontier,
          const std::function<bool(const Cell&, Level)>& take) {
  for (const Level level : levels) {
    Cells taken;
    for (const Cell& cell : frontier) {
      for (const Cell& next : around(cell)) {
        if (take(next, level)) taken.insert(next);
      }
    }
    frontier = taken;
  }
}

}  // namespace

Oracle::Oracle(const Parameters& parameters, const ScanSource& scans)
    : p_(parameters), voxel_(parameters.sub_voxel_size * 4) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    ScanVoxels voxels = voxels_of(scan);
    count_hits(voxels);
    grow_in_scan(voxels);
    remove_from_map(count_passes(passed_by_rays(scan, voxels, scans.sensor())));
    integrate(voxels, i);
  }
}

Mask Oracle::mask(const Scan& scan) const {
  Mask mask;
  for (const Eigen::Vector3f& point : scan.points) {
    const auto found =
        points_.find(cell_of(scan.T_world_sensor * point.cast<double>(), p_.sub_voxel_size));
    mask.push_back(found != points_.end() && found->second.level != Level::kStatic ? 1 : 0);
  }
  return mask;
}

Cell Oracle::block_of(const Cell& voxel) const {
  return {voxel[0] >> 3, voxel[1] >> 3, voxel[2] >> 3};
}

Cell Oracle::voxel_of(const Cell& sub_voxel) const {
  Cell voxel;
  for (std::size_t k = 0; k < 3; ++k) {
    voxel[k] = floor_of((sub_voxel[k] + 0.5) / 4);
  }
  return voxel;
}

Oracle::ScanVoxels Oracle::voxels_of(const Scan& scan) const {
  ScanVoxels voxels;
  for (const Eigen::Vector3f& point : scan.points) {
    const double range = point.cast<double>().norm();
    const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
    const double height = world.z() - scan.T_world_sensor.translation().z();
    if (range < p_.minimum_range || range > p_.maximum_range) continue;
    if (height < p_.lowest || height > p_.highest) continue;
    const Cell sub_voxel = cell_of(world, p_.sub_voxel_size);
    Seen& seen = voxels[voxel_of(sub_voxel)];
    seen.sum += world;
    ++seen.points;
    seen.sub_voxels.insert(sub_voxel);
  }
  return voxels;
}

void Oracle::count_hits(ScanVoxels& voxels) {
  std::vector<Cell> reverted;
  for (auto& [cell, seen] : voxels) {
    if (blocks_.count(block_of(cell)) == 0) continue;
    Space& space = space_[cell];
    space.passes = 0;
    ++space.hits;
    if (space.is_free) seen.level = Level::kConservative;
    if (space.hits >= p_.counts_to_revert) reverted.push_back(cell);
  }
  for (const Cell& cell : reverted) {
    revert(cell);
    for (const Cell& next : around(cell)) revert(next);
  }
}

void Oracle::revert(const Cell& voxel) {
  const auto found = space_.find(voxel);
  if (found == space_.end() || !found->second.is_free) return;
  found->second.is_free = false;
}

void Oracle::grow_in_scan(ScanVoxels& voxels) const {
  Cells seeds;
  for (const auto& [cell, seen] : voxels) {
    if (seen.level == Level::kConservative) seeds.insert(cell);
  }
  grow({Level::kModerate, Level::kAggressive, Level::kAggressive}, seeds,
       [&](const Cell& cell, Level level) {
         const auto found = voxels.find(cell);
         if (found == voxels.end() || found->second.level != Level::kStatic) return false;
         found->second.level = level;
         return true;
       });
}

Cells Oracle::passed_by_rays(const Scan& scan, const ScanVoxels& voxels,
                             const SensorModel& sensor) const {
  const Eigen::Vector3d position = scan.T_world_sensor.translation();
  Cells passed;
  for (const auto& [cell, seen] : voxels) {
    follow(position, seen.sum / seen.points - position, voxels, passed);
  }
  if (!p_.enhancement) return passed;
  for (const Eigen::Vector3d& end : find_hole_ends(scan, view_for(sensor, p_.image_maximum))) {
    follow(position, scan.T_world_sensor.linear() * end, voxels, passed);
  }
  return passed;
}

void Oracle::follow(const Eigen::Vector3d& sensor, Eigen::Vector3d way, const ScanVoxels& voxels,
                    Cells& passed) const {
  if (way.norm() > p_.ray_range) way *= p_.ray_range / way.norm();
  if (way.z() > p_.ray_highest) way *= p_.ray_highest / way.z();
  if (way.z() < p_.ray_lowest) way *= p_.ray_lowest / way.z();
  Cell cell = cell_of(sensor, voxel_);
  const Cell last = cell_of(sensor + way, voxel_);
  while (cell != last && voxels.count(cell) == 0) {
    passed.insert(cell);
    std::size_t axis = 3;
    double nearest = 2.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (way[i] == 0.0) continue;
      const double wall = (cell[k] + (way[i] > 0.0 ? 1 : 0)) * voxel_;
      const double when = (wall - sensor[i]) / way[i];
      if (when < nearest) {
        nearest = when;
        axis = k;
      }
    }
    if (axis == 3) return;
    cell[axis] += way[static_cast<Eigen::Index>(axis)] > 0.0 ? 1 : -1;
  }
}

bool Oracle::is_full(const Cell& block) const {
  for (int i = 0; i < 512; ++i) {
    const auto found =
        space_.find({block[0] * 8 + i / 64, block[1] * 8 + i / 8 % 8, block[2] * 8 + i % 8});
    if (found == space_.end() || !found->second.is_free) return false;
  }
  return true;
}

Cells Oracle::count_passes(const Cells& passed) {
  Cells full, counted, newly_free;
  for (const Cell& block : blocks_) {
    if (is_full(block)) full.insert(block);
  }
  for (const Cell& cell : passed) {
    blocks_.insert(block_of(cell));
    if (full.count(block_of(cell)) > 0) continue;
    ++space_[cell].passes;
    space_[cell].hits = 0;
    counted.insert(cell);
  }
  const auto is_ready = [&](const Cell& cell) {
    const auto found = space_.find(cell);
    return found != space_.end() && found->second.passes >= p_.counts_to_free;
  };
  for (const Cell& cell : counted) {
    bool all = is_ready(cell) && !space_[cell].is_free;
    for (const Cell& next : around(cell)) all = all && is_ready(next);
    if (all) newly_free.insert(cell);
  }
  for (const Cell& cell : newly_free) space_[cell].is_free = true;
  return newly_free;
}

void Oracle::remove_from_map(const Cells& newly_free) {
  std::map<std::size_t, CellMap<std::vector<Cell>>> by_scan;  // Voxel, its sub-voxels.
  for (const auto& [cell, point] : points_) {
    if (point.level != Level::kEmpty) by_scan[point.scan][voxel_of(cell)].push_back(cell);
  }
  Cells touched;
  for (auto& [scan, voxels] : by_scan) {
    CellMap<Level> levels;
    Cells seeds;
    for (const Cell& cell : newly_free) {
      if (voxels.count(cell) == 0) continue;
      levels[cell] = Level::kConservative;
      seeds.insert(cell);
    }
    grow({Level::kModerate, Level::kAggressive}, seeds,
         [&, &of_scan = voxels](const Cell& cell, Level level) {
           return of_scan.count(cell) > 0 && levels.emplace(cell, level).second;
         });
    for (const auto& [voxel, level] : levels) {
      touched.insert(voxel);
      for (const Cell& cell : voxels[voxel]) {
        points_[cell].level = std::max(points_[cell].level, level);
      }
    }
  }
  Cells with_static;
  for (const auto& [cell, point] : points_) {
    if (point.level == Level::kStatic) with_static.insert(voxel_of(cell));
  }
  for (auto& [cell, point] : points_) {
    const Cell voxel = voxel_of(cell);
    if (touched.count(voxel) > 0 && with_static.count(voxel) == 0) point = Point{};
  }
}

void Oracle::integrate(const ScanVoxels& voxels, std::size_t scan) {
  for (const auto& [cell, seen] : voxels) {
    for (const Cell& sub_voxel : seen.sub_voxels) {
      Point& point = points_[sub_voxel];
      if (seen.level < point.level) point = {scan, seen.level};
    }
  }
}

}  // namespace raymoval::freedom_test
