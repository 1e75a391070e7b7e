// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

struct PartSpec;

/// A town house in a closed row: storeys with panes set back in the wall, a gateway, a balcony, a
/// roof. Front at y = 0, x from -length / 2 to length / 2.
Mesh make_block(const PartSpec& spec, Random& random);
/// A detached house with a gable roof and a porch.
Mesh make_house(const PartSpec& spec, Random& random);
Mesh make_garage(const PartSpec& spec, Random& random);

}  // namespace raymoval::simulated
