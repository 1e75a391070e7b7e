// SPDX-License-Identifier: MIT
#include "methods/octomap/beam_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymoval {
namespace {

/// What a walk knows of an axis.
struct AxisWalk {
  CellCode others;  ///< Bits of the two other axes.
  CellCode step;    ///< +1 or -1 in the bits of this axis.
  double to_next;   ///< Distance along the beam at which it leaves its cell along this axis.
  double per_cell;  ///< Distance along the beam from one wall of this axis to the next.
};

AxisWalk axis_walk(unsigned axis, float direction, const std::array<double, 2>& to_wall,
                   double resolution) {
  constexpr double kNever = std::numeric_limits<double>::max();
  const CellCode bits = kAxisBits << axis;
  if (!(direction > 0.0F) && !(direction < 0.0F)) return {~bits, 0, kNever, kNever};
  const bool up = direction > 0.0F;
  return {~bits, up ? CellCode{1} << axis : bits, to_wall[up ? 1 : 0] / direction,
          resolution / std::fabs(static_cast<double>(direction))};
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
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  AxisWalk x = axis_walk(0, direction(0), to_wall_[0], resolution_);
  AxisWalk y = axis_walk(1, direction(1), to_wall_[1], resolution_);
  AxisWalk z = axis_walk(2, direction(2), to_wall_[2], resolution_);
  FreeMarker marker(cells);
  CellCode cell = *first_;
  double leaves = 0.0;  // Distance at which the beam leaves `cell`; past the end only by rounding.
  do {
    marker.mark(cell);
    // Adding in the bits of one axis: the other bits are all ones and pass the carry on. Ties go
    // to the later axis.
    const auto step_along = [&cell](AxisWalk& axis) {
      cell = (((cell | axis.others) + axis.step) & ~axis.others) | (cell & axis.others);
      axis.to_next += axis.per_cell;
    };
    if (x.to_next < y.to_next) {
      step_along(x.to_next < z.to_next ? x : z);
    } else {
      step_along(y.to_next < z.to_next ? y : z);
    }
    leaves = std::min(std::min(x.to_next, y.to_next), z.to_next);
  } while (cell != last && !(leaves > length));
}

}  // namespace raymoval
