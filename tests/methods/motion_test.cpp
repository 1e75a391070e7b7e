// SPDX-License-Identifier: MIT
// Where the world's origin lies and which way its axes point is nobody's business: what a method
// answers may depend on it only through the lattice of its voxels.
#include <catch2/catch.hpp>

#include "tests/methods/moved_world.h"

using namespace raymoval;

TEST_CASE("whole voxels and quarter turns change no verdict") {
  const toy::World world = toy::street(8);
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->needs_truth) continue;
    for (const MethodVariant& variant : entry->variants) {
      const auto method = MethodRegistry::built_in().configure(entry->name + ":" + variant.name);
      INFO(method.full_name());
      const MaskStore here = masks_of(*method.make(), world);
      // 12.8 m, 6.4 m and 3.2 m are whole numbers of 0.05, 0.1, 0.2 and 0.4 m and of powers of two.
      for (const Pose& motion :
           {toy::whole_motion(12.8, -6.4, 3.2, 0), toy::whole_motion(0, 0, 0, 1)}) {
        const MaskStore there = masks_of(*method.make(), toy::MovedWorld(world, motion));
        CHECK(toy::different_verdicts(here, there, world.size()) == 0);
      }
    }
  }
}
