// SPDX-License-Identifier: MIT
#include "methods/dufomap/beams.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "methods/common/diamond_angle.h"

namespace raymoval::dufomap_method {
namespace {

/// Sorts voxels into sectors around the sensor, keeping their order within a sector.
std::vector<VoxelIndex> by_sector(const std::vector<VoxelIndex>& voxels,
                                  const Eigen::Vector3d& sensor) {
  constexpr std::size_t kSectors = 2048;
  std::vector<std::uint16_t> sector(voxels.size());
  std::vector<std::size_t> start(kSectors + 1, 0);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const double angle =
        diamond_angle(voxels[i].x() + 0.5 - sensor.x(), voxels[i].y() + 0.5 - sensor.y());
    const auto s = std::min(static_cast<std::size_t>(angle * (kSectors / 4.0)), kSectors - 1);
    sector[i] = static_cast<std::uint16_t>(s);
    ++start[s + 1];
  }
  for (std::size_t s = 0; s < kSectors; ++s) start[s + 1] += start[s];
  std::vector<VoxelIndex> sorted(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i) sorted[start[sector[i]]++] = voxels[i];
  return sorted;
}

/// A beam from the sensor to the centre of a voxel; lengths in voxels.
struct Beam {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0.0;

  Beam(const Eigen::Vector3d& sensor, const VoxelIndex& end) {
    const Eigen::Vector3d to_end = (end.cast<double>().array() + 0.5).matrix() - sensor;
    length = to_end.norm();
    if (length > 0.0) direction = to_end / length;
  }
};

/// Step 2: the voxels within `hit_extension` before the end of a beam, from the end backwards.
void mark_hits(const Beam& beam, const VoxelIndex& end, double hit_extension, ScanGrid& grid) {
  grid.column(end).hit |= bit_of(end);
  CellWalk walk((end.cast<double>().array() + 0.5).matrix(), -beam.direction, end);
  while (walk.next_distance() < hit_extension) {
    walk.advance();
    grid.column(walk.cell()).hit |= bit_of(walk.cell());
  }
}

/// The second part of step 3: continues from the end of the beam until it has advanced `margin`
/// voxels along one axis.
void mark_compensation(const Eigen::Vector3d& sensor, const Beam& beam, const VoxelIndex& stop,
                       int margin, ScanGrid& grid) {
  CellWalk walk(sensor, beam.direction, stop);
  std::array<int, 3> advanced{};
  while (true) {
    const std::size_t axis = walk.advance();
    grid.column(walk.cell()).free |= bit_of(walk.cell());
    if (++advanced[axis] >= margin) return;
  }
}

}  // namespace

std::vector<VoxelIndex> voxels_of(const Scan& scan, double voxel_size) {
  const double inverse = 1.0 / voxel_size;
  std::vector<VoxelIndex> voxels(scan.size());
  for (std::size_t k = 0; k < scan.size(); ++k) {
    voxels[k] = voxel_index(scan.T_world_sensor * scan.points[k].cast<double>(), inverse);
  }
  return voxels;
}

std::vector<VoxelIndex> beam_ends(const Scan& scan, const std::vector<VoxelIndex>& voxels,
                                  const Parameters& parameters, ScanGrid& grid) {
  const double nearest = parameters.minimum_range * parameters.minimum_range;
  std::vector<VoxelIndex> ends;
  ends.reserve(voxels.size());
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    if (scan.points[k].cast<double>().squaredNorm() < nearest) continue;
    std::uint64_t& seen = grid.column(voxels[k]).free;  // Used as scratch: no voxel is free yet.
    if ((seen & bit_of(voxels[k])) != 0) continue;
    seen |= bit_of(voxels[k]);
    ends.push_back(voxels[k]);
  }
  for (const VoxelIndex& end : ends) grid.column(end).free = 0;
  return by_sector(ends, scan.T_world_sensor.translation() / parameters.voxel_size);
}

void cast_beams(const Scan& scan, const std::vector<VoxelIndex>& ends, const Parameters& parameters,
                ScanGrid& grid, const RunContext& context) {
  constexpr std::size_t kBeamsInTurn = 512;  // Between two checks for a cancel.
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation() / parameters.voxel_size;
  const double extension = parameters.hit_extension / parameters.voxel_size;
  for (const VoxelIndex& end : ends) mark_hits(Beam(sensor, end), end, extension, grid);

  const int margin = parameters.compensate_inflation ? parameters.unknown_inflation : 0;
  const double farthest = parameters.maximum_range > 0.0
                              ? parameters.maximum_range / parameters.voxel_size
                              : std::numeric_limits<double>::infinity();
  FreeWalk walk(sensor, grid);
  std::size_t count = 0;
  for (const VoxelIndex& end : ends) {
    if (++count % kBeamsInTurn == 0) context.check_cancelled();
    const Beam beam(sensor, end);
    if (beam.length == 0.0) continue;
    const double length = std::min(beam.length, farthest);
    if (length > FreeWalk::kLongest) {
      throw DataError("scan " + scan.name + ": a point lies " +
                      number_text(std::round(beam.length * parameters.voxel_size)) +
                      " m from the sensor; dufomap follows beams of at most 131,072 voxels. Remove "
                      "the point, or set dufomap.maximum_range.");
    }
    const VoxelIndex stop = walk.mark_free(beam.direction, length);
    if (margin > 0) mark_compensation(sensor, beam, stop, margin, grid);
  }
}

}  // namespace raymoval::dufomap_method
