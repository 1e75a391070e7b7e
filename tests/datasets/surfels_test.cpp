// SPDX-License-Identifier: MIT
#include "datasets/geometry/surfels.h"

#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

void add(int count, Surfel::Group group, const Eigen::Vector3d& axis, std::vector<Surfel>& all) {
  for (int i = 0; i < count; ++i) all.push_back({{0.8 * i, 0.0, 0.0}, axis.normalized(), group});
}

}  // namespace

TEST_CASE("the part of a shift is found that surfels hold") {
  using Eigen::Vector3d;
  const Vector3d shift(1.0, 2.0, 3.0);
  CHECK(held_part(shift, {}, 12.0).norm() == 0.0);
  std::vector<Surfel> ground;
  add(50, Surfel::Group::kNormalZ, Vector3d::UnitZ(), ground);
  CHECK(held_part(shift, ground, 12.0).isApprox(Vector3d(0.0, 0.0, 3.0)));
  // A rail along x does not hold along x. Signs across the road do, if they are not too few.
  std::vector<Surfel> road = ground;
  add(20, Surfel::Group::kNormalY, Vector3d::UnitY(), road);
  CHECK(held_part(shift, road, 12.0).isApprox(Vector3d(0.0, 2.0, 3.0)));
  add(7, Surfel::Group::kNormalX, Vector3d::UnitX(), road);
  CHECK(held_part(shift, road, 12.0).isApprox(Vector3d(0.0, 2.0, 3.0)));
  CHECK(held_part(shift, road, 6.9).isApprox(shift));
  // Poles hold across themselves, along both x and y.
  std::vector<Surfel> poles = ground;
  add(13, Surfel::Group::kLine, Vector3d::UnitZ(), poles);
  CHECK(held_part(shift, poles, 12.0).isApprox(shift));
  // Walls at a right angle that no axis is along: directions are found, not chosen from three.
  std::vector<Surfel> walls;
  add(18, Surfel::Group::kNormalX, {1.0, 1.0, 0.0}, walls);
  add(5, Surfel::Group::kNormalY, {-1.0, 1.0, 0.0}, walls);
  CHECK(held_part(shift, walls, 12.0).isApprox(Vector3d(1.5, 1.5, 0.0)));
}
