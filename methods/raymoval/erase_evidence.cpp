// SPDX-License-Identifier: MIT
#include "methods/raymoval/erase_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/raymoval/consistency.h"

namespace raymoval::raymoval_method {
namespace {

/// Rows of the grid between neighbouring beams, so that a window of this radius holds a return if
/// the surface continues. Beams more than half a degree apart do not support each other: at 20 m
/// that is 17 cm, about a voxel.
int rows_of_a_beam(const SensorModel& sensor, const AngularGrid& grid,
                   const Parameters& parameters) {
  if (parameters.erase_elevation_window >= 0) return parameters.erase_elevation_window;
  constexpr double kFarthest = 0.5 * std::numbers::pi / 180.0;
  const double step =
      sensor.elevation_step > 0.0 ? std::min(sensor.elevation_step, kFarthest) : kFarthest;
  return std::clamp(static_cast<int>(std::ceil(step / grid.elevation_step())), 1, 100);
}

}  // namespace

EvidenceFinder::EvidenceFinder(const Parameters& parameters, const SensorModel& sensor,
                               const AngularGrid& grid)
    : parameters_(parameters), erase_rows_(rows_of_a_beam(sensor, grid, parameters)) {}

std::vector<VoxelIndex> EvidenceFinder::find(const ScanAgainstMap& scan, const OccupancyMap& map,
                                             const RunContext& context) {
  const StageScope timed(context.times, "erase");
  std::vector<VoxelIndex> voxels;
  const BinWindow neighbourhood{scan.grid(), parameters_.erase_azimuth_window, erase_rows_};
  const FirstHitImage& image = scan.first_hit();
  for (const SeenThrough& through :
       find_seen_through(scan.projected(), neighbourhood, image, scan.erase_reference(),
                         {parameters_.erase_tau0, parameters_.erase_tau1}, context.threads)) {
    const float first_hit = image.range[static_cast<std::size_t>(through.bin)];
    const bool along_surface = through.nearest_return - first_hit <
                               grazing_distance(image.ray(through.bin).direction.z(),
                                                parameters_.erase_height * parameters_.voxel_size,
                                                parameters_.erase_height_limit);
    if (along_surface) continue;
    const auto voxel = image.voxel(map, through.bin);
    if (voxel) voxels.push_back(*voxel);
  }
  drop_own_voxels(scan, map, voxels);
  return voxels;
}

/// A ray may pass through the empty part of a voxel, so a voxel with a point of the same scan is
/// not seen through.
void EvidenceFinder::drop_own_voxels(const ScanAgainstMap& scan, const OccupancyMap& map,
                                     std::vector<VoxelIndex>& voxels) {
  if (voxels.empty()) return;
  const auto slot_of = [&](const VoxelIndex& voxel) {
    return map.find_slot(OccupancyMap::brick_of(voxel));
  };
  std::vector<OccupancyMap::Slot> bricks;
  number_of_.resize(map.brick_count(), 0);
  for (const VoxelIndex& voxel : voxels) {
    std::uint32_t& number = number_of_[slot_of(voxel)];
    if (number != 0) continue;
    bricks.push_back(slot_of(voxel));
    number = static_cast<std::uint32_t>(bricks.size());
  }
  std::vector<Brick> own(bricks.size());             // The scan's voxels in these bricks.
  OccupancyMap::Slot last = OccupancyMap::kNoBrick;  // Neighbours often share a brick.
  Brick* open = nullptr;
  const std::vector<OccupancyMap::Slot>& slots = scan.known().slots;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const OccupancyMap::Slot slot = slots[k];
    if (slot != last) {
      last = slot;
      const std::uint32_t number = slot == OccupancyMap::kNoBrick ? 0 : number_of_[slot];
      open = number == 0 ? nullptr : &own[number - 1];
    }
    if (open == nullptr) continue;
    const VoxelIndex& voxel = scan.voxels().voxels[k];
    open->add(voxel.x(), voxel.y(), voxel.z());
  }
  std::erase_if(voxels, [&](const VoxelIndex& voxel) {
    return own[number_of_[slot_of(voxel)] - 1].contains(voxel.x(), voxel.y(), voxel.z());
  });
  for (const OccupancyMap::Slot slot : bricks) number_of_[slot] = 0;
}

}  // namespace raymoval::raymoval_method
