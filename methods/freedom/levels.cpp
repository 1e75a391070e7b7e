// SPDX-License-Identifier: MIT
#include "methods/freedom/levels.h"

#include <cstdlib>

namespace raymoval::freedom_method {
namespace {

std::vector<VoxelIndex> make_offsets() {
  std::vector<VoxelIndex> offsets;
  for (int axes = 1; axes <= 3; ++axes) {  // Faces, edges, corners.
    for (int i = 0; i < 27; ++i) {
      const VoxelIndex offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (offset.cwiseAbs().sum() == axes) offsets.push_back(offset);
    }
  }
  return offsets;
}

int first_round(Neighbours neighbours) {
  switch (neighbours) {
    case Neighbours::k6:
      return 6;
    case Neighbours::k18:
      return 18;
    case Neighbours::k26:
    case Neighbours::k80:
    case Neighbours::k124:
      return 26;
  }
  return 0;
}

int second_round(Neighbours neighbours) {
  if (neighbours == Neighbours::k80) return 6;
  return neighbours == Neighbours::k124 ? 26 : 0;
}

}  // namespace

std::span<const VoxelIndex> neighbour_offsets(int count) {
  static const std::vector<VoxelIndex> offsets = make_offsets();
  return std::span(offsets).first(static_cast<std::size_t>(count));
}

Growth growth_of(const Parameters& parameters, bool in_map) {
  Growth growth;
  growth.moderate = first_round(parameters.conservative_neighbours);
  growth.aggressive = {first_round(parameters.aggressive_neighbours),
                       second_round(parameters.aggressive_neighbours)};
  if (in_map && parameters.public_second_round) growth.aggressive[1] = 0;
  return growth;
}

}  // namespace raymoval::freedom_method
