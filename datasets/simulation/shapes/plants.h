// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

struct PartSpec;

/// Trunk, branches and a porous crown, one branch hanging out over the road (towards -y).
Mesh make_tree(const PartSpec& spec, Random& random);
Mesh make_conifer(const PartSpec& spec, Random& random);
/// A clipped hedge: leaves around a denser core.
Mesh make_hedge(const PartSpec& spec, Random& random);
Mesh make_bush(const PartSpec& spec, Random& random);
/// A strip of grass and weeds, knee-high.
Mesh make_tall_grass(const PartSpec& spec, Random& random);

}  // namespace raymoval::simulated
