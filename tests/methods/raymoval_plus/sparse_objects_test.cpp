// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/sparse_objects.h"

#include <catch2/catch.hpp>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// An object whose box is 0.6 m x 0.8 m, 1 m wide seen from above, and 1 m high.
ObjectSummary object_of(int points, float range) {
  ObjectSummary object;
  object.low = {3.0, 4.0, 0.5};
  object.high = {3.6, 4.8, 1.5};
  object.range = range;
  object.points = points;
  return object;
}

}  // namespace

TEST_CASE("an object is sparse if it has less than three in a hundred of a surface's points") {
  // 5 m away each direction has 0.0025 m^2: there are 400 on 1 m^2. Twice as far there are 100.
  const DirectionSteps steps{0.01F, 0.01F};
  CHECK(is_sparse(object_of(11, 5.0F), steps));
  CHECK_FALSE(is_sparse(object_of(13, 5.0F), steps));
  CHECK(is_sparse(object_of(2, 10.0F), steps));
  CHECK_FALSE(is_sparse(object_of(4, 10.0F), steps));
  // Beams five times as far apart.
  CHECK(is_sparse(object_of(2, 5.0F), {0.01F, 0.05F}));
  CHECK_FALSE(is_sparse(object_of(3, 5.0F), {0.01F, 0.05F}));
}

TEST_CASE("where the steps are unknown, nothing is sparse") {
  for (const DirectionSteps& steps : {DirectionSteps{}, {0.01F, 0.0F}, {0.0F, 0.01F}}) {
    CHECK_FALSE(is_sparse(object_of(1, 1.0F), steps));
  }
}

TEST_CASE("a post, which is as wide as its points, is not sparse") {
  ObjectSummary post = object_of(2, 5.0F);
  post.high.head<2>() = post.low.head<2>();
  CHECK_FALSE(is_sparse(post, {0.01F, 0.01F}));
}

}  // namespace raymoval::raymoval_plus_test
