// SPDX-License-Identifier: MIT
#include "tests/methods/freedom/oracle.h"

#include <catch2/catch.hpp>

#include "methods/freedom/freedom.h"
#include "tests/methods/properties/random_world.h"
#include "tests/methods/toy_world.h"

namespace raymoval::freedom_test {
using freedom_test::Oracle;

namespace {

/// Low counts, so that few scans free voxels and take that back.
freedom_method::Parameters some_parameters(int variant) {
  freedom_method::Parameters p;
  p.counts_to_free = 2;
  p.counts_to_revert = 3;
  if (variant == 1) p.enhancement = false;
  if (variant == 2) p.sub_voxel_size = 0.13;
  if (variant == 3) {
    p.ray_range = 12.0;
    p.ray_lowest = -1.0;
    p.ray_highest = 0.8;
  }
  return p;
}

}  // namespace

TEST_CASE("freedom: the fast way gives what the description says") {
  std::size_t removed = 0;
  for (int variant = 0; variant < 4; ++variant) {
    const freedom_method::Parameters parameters = some_parameters(variant);
    const toy::HeldScans world = toy::random_world(
        {.scans = 5, .walls = 3, .movers = 4, .seed = 20U + static_cast<unsigned>(variant)});
    INFO("variant " << variant);
    const Oracle oracle(parameters, world);
    const MaskStore masks =
        toy::masks_of(*freedom_method::make_freedom(parameters), world, 1 + variant % 3);
    for (std::size_t i = 0; i < world.size(); ++i)
      CHECK(masks.get(i) == oracle.mask(world.load(i)));
    removed += masks.removed_count();
  }
  CHECK(removed > 500);
}

}  // namespace raymoval::freedom_test
