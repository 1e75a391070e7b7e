// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/fine_cells.h"

#include <algorithm>
#include <utility>

namespace raymoval::dynamicmap {
namespace {

/// The smallest edge of a block, metres.
constexpr double kSmallestEdge = 0.2;
/// Relative margin of a fine cell's edge over half of the distance. Rounding is a thousand times
/// smaller.
constexpr double kMargin = 1e-6;

double block_edge(double distance) {
  return std::max(4.0 * distance * (1.0 + kMargin), kSmallestEdge);
}

/// The part of [low, high] that is in a block, whose cells begin at `first`; from its first cell.
struct Span {
  int low, high;
};

Span span_in_block(int centre, int block) {
  return {std::max(centre - FineGrid::kReach, 8 * block) - 8 * block,
          std::min(centre + FineGrid::kReach, 8 * block + 7) - 8 * block};
}

/// The bits of a layer that are in both spans.
std::uint64_t layer_mask(const Span& x, const Span& y) {
  const std::uint64_t row = ((1U << (x.high - x.low + 1)) - 1U) << x.low;
  std::uint64_t mask = 0;
  for (int i = y.low; i <= y.high; ++i) mask |= row << (8 * i);
  return mask;
}

/// First and last block, from -1 to 1, within reach of a cell along an axis.
int first_block(int centre) {
  return centre < FineGrid::kReach ? -1 : 0;
}
int last_block(int centre) {
  return centre + FineGrid::kReach > 7 ? 1 : 0;
}

}  // namespace

FineGrid::FineGrid(double distance) : inverse_edge_(1.0 / block_edge(distance)) {
  const double edge = block_edge(distance) / 8.0;
  same_cell_is_near_ = 3.0 * edge * edge * (1.0 + kMargin) < distance * distance;
}

FineBits::FineBits(RankedBits chosen)
    : chosen_(std::move(chosen)), words_(chosen_.count() * 8, 0) {}

void FineBits::subtract(const FineBits& other) {
  chosen_.for_each([&](Number block) {
    if (!other.is_chosen(block)) return;
    const std::size_t own = index(block, 0), others = other.index(block, 0);
    for (std::size_t layer = 0; layer < 8; ++layer) {
      words_[own + layer] &= ~other.words_[others + layer];
    }
  });
}

bool FineBits::any(Number block) const {
  if (!is_chosen(block)) return false;
  const std::uint64_t* words = words_.data() + index(block, 0);
  return std::any_of(words, words + 8, [](std::uint64_t word) { return word != 0; });
}

bool FineBits::any_near(const FineCell& cell, const CellLattice& lattice,
                        CellLattice::Cursor& cursor, Number first, Number end) const {
  for (int bz = first_block(cell.z); bz <= last_block(cell.z); ++bz) {
    const Span z = span_in_block(cell.z, bz);
    for (int by = first_block(cell.y); by <= last_block(cell.y); ++by) {
      for (int bx = first_block(cell.x); bx <= last_block(cell.x); ++bx) {
        const Number block = lattice.find(cell_beside(cell.block, bx, by, bz), cursor);
        if (block == CellLattice::kNone || block < first || block >= end) continue;
        if (!is_chosen(block)) continue;
        const std::uint64_t* const layers = words_.data() + index(block, 0);
        const std::uint64_t mask = layer_mask(span_in_block(cell.x, bx), span_in_block(cell.y, by));
        for (int layer = z.low; layer <= z.high; ++layer) {
          if ((layers[layer] & mask) != 0) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace raymoval::dynamicmap
