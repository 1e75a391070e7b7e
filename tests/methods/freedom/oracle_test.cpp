// SPDX-License-Identifier: MIT
#include "tests/methods/freedom/oracle.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/freedom/freedom.h"
#include "tests/methods/properties/random_world.h"
#include "tests/methods/toy_world.h"

namespace raymoval::freedom_test {
using freedom_test::Oracle;

namespace {

/// Low counts, so that few scans free voxels and take that back.
freedom_method::Parameters some_parameters(int variant, std::mt19937& random) {
  using freedom_method::Neighbours;
  freedom_method::Parameters p;
  p.counts_to_free = 2;
  p.counts_to_revert = 3;
  const auto coin = [&] { return random() % 2 == 0; };
  if (variant > 0) {
    p.public_second_round = coin();
    p.public_revert = coin();
    p.public_full_blocks = coin();
    p.public_inpainting = coin();
  }
  if (variant == 1) p.aggressive_neighbours = Neighbours::k80;
  if (variant == 2) {
    p.conservative_neighbours = Neighbours::k6;
    p.aggressive_neighbours = Neighbours::k18;
    p.sub_voxels = 3;
  }
  if (variant == 3) {
    p.ray_range = 12.0;
    p.ray_lowest = -1.0;
    p.ray_highest = 0.8;
  }
  return p;
}

}  // namespace

TEST_CASE("freedom: the fast way gives what the description says") {
  std::mt19937 random(5);
  std::size_t removed = 0;
  for (int variant = 0; variant < 4; ++variant) {
    const freedom_method::Parameters parameters = some_parameters(variant, random);
    const toy::ScanList world = toy::random_world(
        {.scans = 5, .walls = 3, .movers = 4, .seed = 20U + static_cast<unsigned>(variant)});
    INFO("variant " << variant);
    const Oracle oracle(parameters, world);
    const MaskStore masks =
        toy::masks_of(*freedom_method::make_freedom(parameters), world, 1 + variant % 3);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < world.size(); ++i) {
      const Mask expected = oracle.mask(world.load(i)), found = masks.get(i);
      REQUIRE(expected.size() == found.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        differences += expected[k] != found[k] ? 1 : 0;
        removed += found[k];
      }
    }
    CHECK(differences == 0);
  }
  CHECK(removed > 500);
}

}  // namespace raymoval::freedom_test
