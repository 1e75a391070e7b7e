// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/simulation/shapes/mesh.h"
#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {

/// A static object of a world. Sizes in metres; 0 = the part's default.
struct PartSpec {
  std::string part;
  double length_m = 0.0;  ///< Along the row.
  double width_m = 0.0;   ///< Away from the road.
  double height_m = 0.0;
  double above_m = 0.0;  ///< Its foot above the ground, such as on a storey.
};

/// A given size, or the usual size.
inline double size_or(double wished, double usual) {
  return wished > 0.0 ? wished : usual;
}

/// A given size that varies by a share of `spread`, or a size between `low` and `high`.
inline double varied(double wished, double spread, Random& random, double low, double high) {
  return wished > 0.0 ? wished * random.between(1.0 - spread, 1.0 + spread)
                      : random.between(low, high);
}

/// Names for `make_part`.
const std::vector<std::string>& part_names();

/// One individual. Frame: x along the road, y away from it (the side towards the road is y = 0 for
/// buildings, fences and the like; poles, trees and vehicles are around the origin), z = 0 on the
/// ground.
/// @param instance number of the object, if it has an instance id; else 0
/// @throws ConfigurationError for an unknown name, suggesting the nearest one.
Mesh make_part(const PartSpec& spec, std::uint16_t instance, Random& random);

/// A town house in a closed row: storeys with panes set back in the wall, a gateway, a balcony, a
/// roof. Front at y = 0, x from -length / 2 to length / 2.
Mesh make_block(const PartSpec& spec, Random& random);
/// A detached house with a gable roof and a porch.
Mesh make_house(const PartSpec& spec, Random& random);
Mesh make_garage(const PartSpec& spec, Random& random);

/// Trunk, branches and a porous crown, one branch hanging out over the road (towards -y).
Mesh make_tree(const PartSpec& spec, Random& random);
Mesh make_conifer(const PartSpec& spec, Random& random);
/// A clipped hedge: leaves around a denser core.
Mesh make_hedge(const PartSpec& spec, Random& random);
Mesh make_bush(const PartSpec& spec, Random& random);
/// A strip of grass and weeds, knee-high.
Mesh make_tall_grass(const PartSpec& spec, Random& random);

/// A market stall: a counter with goods under an awning. Customers are at -y.
Mesh make_stall(const PartSpec& spec, Random& random);
/// A pallet rack with goods on most of its places.
Mesh make_rack(const PartSpec& spec, Random& random);
Mesh make_pillar(const PartSpec& spec, Random& random);
/// A slab with beams: `length_m` by `width_m` around its place, `height_m` above the ground.
Mesh make_ceiling(const PartSpec& spec, Random& random);

/// An inclined slab, `length_m` by `width_m`, that rises along x from the ground to `height_m`.
Mesh make_ramp(const PartSpec& spec, Random& random);

/// Whether a part fills the whole length of its place in a row (fence, hedge).
bool is_continuous(const std::string& part);

/// Whether a part is a single object with an instance id: parked vehicles and bicycles, poles,
/// signs, bins and containers.
bool has_instance(const std::string& part);
/// Radius of a part around its place, to keep it off other roads.
double footprint_radius(const PartSpec& spec);

}  // namespace raymoval::simulated
