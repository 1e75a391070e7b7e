// SPDX-License-Identifier: MIT
#include "methods/peopleremover/beams.h"

#include <array>
#include <cmath>
#include <limits>

namespace raymoval::peopleremover_method {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

using Triple = std::array<int, 3>;
using Times = std::array<double, 3>;

/// The axis whose wall is crossed first; the lower axis if two are crossed at once.
std::size_t first_axis(const Times& times) {
  const std::size_t axis = times[1] < times[0] ? 1 : 0;
  return times[2] < times[axis] ? 2 : axis;
}

}  // namespace

/// A segment on the lattice; time 0 is its start and 1 its end.
struct BeamWalker::Beam {
  std::array<double, 3> start, direction, inverse;
  Triple first, last;  ///< Voxels of both ends.
  Triple step;         ///< 1 or -1.

  /// The time at which the wall at `wall` (voxel units) of `axis` is crossed.
  [[nodiscard]] double time_of(std::size_t axis, int wall) const {
    return (wall - start[axis]) * inverse[axis];
  }
  /// The time at which the beam leaves voxel `at` along `axis`. It never leaves the last voxel.
  [[nodiscard]] double leaves_voxel(std::size_t axis, int at) const {
    if (at == last[axis]) return kNever;
    return time_of(axis, step[axis] > 0 ? at + 1 : at);
  }
  [[nodiscard]] double leaves_brick(std::size_t axis, int brick) const {
    if (brick == last[axis] >> kBrickBits) return kNever;
    return time_of(axis, (step[axis] > 0 ? brick + 1 : brick) * kBrickSide);
  }
};

/// The entry of a beam into a brick: across the wall of `axis` at `time`. The beam leaves at
/// `until`. In the first brick `time` is below every other time.
struct BeamWalker::Entry {
  Triple brick;
  double time;
  std::size_t axis;
  double until;

  /// The voxels that the beam can reach between both times, and possibly a few others.
  [[nodiscard]] BrickWord reach(const Beam& beam) const;
  /// Whether the wall crossed at `crossing` is behind the beam at its entry.
  [[nodiscard]] bool is_behind(double crossing, std::size_t of_axis) const {
    return crossing < time || (crossing == time && of_axis <= axis);
  }
  /// The voxel of the entry.
  [[nodiscard]] Triple voxel(const Beam& beam) const;
};

BrickWord BeamWalker::Entry::reach(const Beam& beam) const {
  constexpr double kMargin = 1e-6;  // Far above the rounding of 2^20 voxels in double precision.
  const double from = std::max(time, 0.0), to = std::min(until, 1.0);
  BrickWord mask = ~BrickWord{0};
  for (std::size_t a = 0; a < 3; ++a) {
    const double corner = beam.start[a] - brick[a] * kBrickSide;
    const double p = corner + beam.direction[a] * from, q = corner + beam.direction[a] * to;
    const double low = std::clamp(std::min(p, q) - kMargin, 0.0, 3.5);
    const double high = std::clamp(std::max(p, q) + kMargin, 0.0, 3.5);
    mask &= slab_masks().of[a][static_cast<std::size_t>(low)][static_cast<std::size_t>(high)];
  }
  return mask;
}

Triple BeamWalker::Entry::voxel(const Beam& beam) const {
  if (time < 0.0) return beam.first;
  Triple at;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [near, far] = std::minmax(beam.first[a], beam.last[a]);
    const int low = std::max(brick[a] * kBrickSide, near);
    const int high = std::min(brick[a] * kBrickSide + kBrickSide - 1, far);
    // A guess, corrected by the walls: the result must equal that of single steps despite rounding.
    const double guess = std::floor(beam.start[a] + beam.direction[a] * time);
    int c = static_cast<int>(std::clamp(guess, double(low), double(high)));
    if (beam.step[a] > 0) {
      while (c < high && is_behind(beam.time_of(a, c + 1), a)) ++c;
      while (c > low && !is_behind(beam.time_of(a, c), a)) --c;
    } else {
      while (c > low && is_behind(beam.time_of(a, c), a)) --c;
      while (c < high && !is_behind(beam.time_of(a, c + 1), a)) ++c;
    }
    at[a] = c;
  }
  return at;
}

BeamWalker::BeamWalker(const BrickMap& map, FreedVoxels& freed, const VoxelMarks& own)
    : map_(map), freed_(freed), own_(own), finder_(map) {}

void BeamWalker::walk(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  if (from == to) return;
  Beam beam;
  Entry entry;
  Times leaves;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    beam.start[a] = from[i];
    beam.direction[a] = to[i] - from[i];
    beam.step[a] = beam.direction[a] < 0.0 ? -1 : 1;
    // Bounded, so that 0 times it is 0. A beam this flat crosses one wall at most.
    beam.inverse[a] = std::clamp(1.0 / beam.direction[a], -1e300, 1e300);
    beam.first[a] = static_cast<int>(std::floor(from[i]));
    beam.last[a] = static_cast<int>(std::floor(to[i]));
    entry.brick[a] = beam.first[a] >> kBrickBits;
    leaves[a] = beam.leaves_brick(a, entry.brick[a]);
  }
  visit_first({beam.first[0], beam.first[1], beam.first[2]});
  if (beam.first == beam.last) return;
  entry.time = -1.0;
  entry.axis = 0;
  for (;;) {
    const std::size_t axis = first_axis(leaves);
    entry.until = leaves[axis];
    const BrickId brick = finder_.find(entry.brick[0], entry.brick[1], entry.brick[2]);
    if (brick != kNoBrick && walk_brick(beam, entry, brick)) return;
    if (entry.until == kNever) return;
    entry.brick[axis] += beam.step[axis];
    entry.time = entry.until;
    entry.axis = axis;
    leaves[axis] = beam.leaves_brick(axis, entry.brick[axis]);
  }
}

/// A point of the window in the sensor's voxel does not stop a beam.
void BeamWalker::visit_first(const VoxelIndex& voxel) {
  const BrickId brick = finder_.find(brick_of(voxel));
  if (brick == kNoBrick) return;
  const BrickWord freed = voxel_bit(voxel) & map_.occupied(brick) & ~own_.at(brick);
  if ((freed & ~freed_.load(brick)) != 0) freed_.set(brick, freed);
}

/// Visits the voxels on the way through one brick. @return whether the beam was stopped there
bool BeamWalker::walk_brick(const Beam& beam, const Entry& entry, BrickId brick) {
  const BrickWord own = own_.at(brick);
  const BrickWord foreign = map_.occupied(brick) & ~own & ~freed_.load(brick);
  // Without a voxel that can be freed or can stop the beam, the walk through the brick has no
  // effect.
  if ((own | foreign) == 0 || ((own | foreign) & entry.reach(beam)) == 0) return false;
  Triple at = entry.voxel(beam);
  Times leaves;
  for (std::size_t a = 0; a < 3; ++a) leaves[a] = beam.leaves_voxel(a, at[a]);
  bool skip = entry.time < 0.0, stopped = false;  // The first voxel was visited before.
  BrickWord visited = 0;
  for (;;) {
    const BrickWord bit = voxel_bit(at[0], at[1], at[2]);
    if (!skip && (bit & own) != 0) {
      stopped = true;
      break;
    }
    visited |= skip ? 0 : bit;
    skip = false;
    const std::size_t axis = first_axis(leaves);
    if (leaves[axis] == kNever) break;
    at[axis] += beam.step[axis];
    if (at[axis] >> kBrickBits != entry.brick[axis]) break;
    leaves[axis] = beam.leaves_voxel(axis, at[axis]);
  }
  if ((visited & foreign) != 0) freed_.set(brick, visited & foreign);
  return stopped;
}

}  // namespace raymoval::peopleremover_method
