// SPDX-License-Identifier: MIT
#include "methods/octomap/beam_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymoval::octomap_method {
namespace {

/// What a walk knows of an axis.
struct AxisWalk {
  CellCode step;    ///< +1 or -1 in the bits of this axis.
  double to_next;   ///< Along the beam to the cell's wall of this axis, metres.
  double per_cell;  ///< Along the beam from one wall of this axis to the next, metres.
};

AxisWalk axis_walk(unsigned axis, float direction, const std::array<double, 2>& to_wall,
                   double resolution) {
  constexpr double kNever = std::numeric_limits<double>::max();
  if (!(direction > 0.0F) && !(direction < 0.0F)) return {0, kNever, kNever};
  const bool up = direction > 0.0F;
  return {up ? CellCode{1} << axis : kAxisBits << axis, to_wall[up ? 1 : 0] / direction,
          resolution / std::fabs(static_cast<double>(direction))};
}

/// Makes `direction` a unit vector. @return the length that it had, metres
float normalise(octomap::point3d& direction) {
  // The square of a shorter length is no normal number: the length would come out as zero or with
  // few digits, and the walk would not end.
  constexpr float kShort = 0x1p-50F, kLonger = 0x1p+90F;
  const bool is_short = std::max({std::fabs(direction.x()), std::fabs(direction.y()),
                                  std::fabs(direction.z())}) < kShort;
  if (is_short) direction *= kLonger;
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  return is_short ? length / kLonger : length;
}

/// A line crosses at most sqrt(3) times as many walls as cells fit into its length, and one more
/// along each axis at either end; so it passes through fewer cells than this. It bounds a walk
/// whatever rounding makes of it.
int most_cells(float length, double resolution) {
  return static_cast<int>(2.0 * std::min(length / resolution, 1e6)) + 8;
}

/// Steps along an axis by adding in its bits: all others are ones and pass the carry on.
template <unsigned kAxis>
void step_along(AxisWalk& axis, CellCode& cell) {
  constexpr CellCode kBits = kAxisBits << kAxis;
  cell = (((cell | ~kBits) + axis.step) & kBits) | (cell & ~kBits);
  axis.to_next += axis.per_cell;
}

/// Sets bits of cells that mostly follow each other within a block.
class FreeMarker {
 public:
  explicit FreeMarker(CellBlocks& cells) : cells_(cells) {}
  void mark(CellCode cell) {
    if (cell >> kBlockBits != block_) {
      block_ = cell >> kBlockBits;
      words_ = cells_.block(block_).free.data();
    }
    words_[cell >> 6 & 7] |= std::uint64_t{1} << (cell & 63);
  }

 private:
  CellBlocks& cells_;
  std::uint64_t block_ = ~std::uint64_t{0};
  std::uint64_t* words_ = nullptr;
};

}  // namespace

std::optional<CellCode> CellLattice::cell_of(const octomap::point3d& point) const {
  CellCode code = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double key = std::floor(factor_ * static_cast<double>(point(axis))) + kCentre;
    if (!(key >= 0.0 && key < 2.0 * kCentre)) return std::nullopt;
    code |= spread_bits(static_cast<std::uint16_t>(key)) << axis;
  }
  return code;
}

octomap::point3d CellLattice::centre(CellCode cell) const {
  return {static_cast<float>(centre(gather_bits(cell))),
          static_cast<float>(centre(gather_bits(cell >> 1))),
          static_cast<float>(centre(gather_bits(cell >> 2)))};
}

BeamTracer::BeamTracer(const CellLattice& lattice, const octomap::point3d& origin)
    : origin_(origin), first_(lattice.cell_of(origin)), resolution_(lattice.resolution()) {
  if (!first_) return;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double centre = lattice.centre(gather_bits(*first_ >> axis));
    to_wall_[axis] = {centre - lattice.half_cell() - origin(axis),
                      centre + lattice.half_cell() - origin(axis)};
  }
}

void BeamTracer::mark_free(const octomap::point3d& end, CellCode last, CellBlocks& cells) const {
  if (!first_ || *first_ == last) return;
  octomap::point3d direction = end - origin_;
  const float length = normalise(direction);
  AxisWalk x = axis_walk(0, direction(0), to_wall_[0], resolution_);
  AxisWalk y = axis_walk(1, direction(1), to_wall_[1], resolution_);
  AxisWalk z = axis_walk(2, direction(2), to_wall_[2], resolution_);
  FreeMarker marker(cells);
  CellCode cell = *first_;
  double leaves_at = 0.0;  // Distance at which the beam leaves the cell; past the end by rounding.
  int cells_left = most_cells(length, resolution_);
  do {
    marker.mark(cell);
    // Through the nearest wall; of two equally near, that of the later axis.
    if (x.to_next < y.to_next && x.to_next < z.to_next) {
      step_along<0>(x, cell);
    } else if (!(x.to_next < y.to_next) && y.to_next < z.to_next) {
      step_along<1>(y, cell);
    } else {
      step_along<2>(z, cell);
    }
    leaves_at = std::min(std::min(x.to_next, y.to_next), z.to_next);
  } while (cell != last && !(leaves_at > length) && --cells_left > 0);
}

}  // namespace raymoval::octomap_method
