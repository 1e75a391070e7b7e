// SPDX-License-Identifier: MIT
#include "datasets/geometry/surfels.h"

#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

void add(int count, Surfel::Group group, const Eigen::Vector3d& axis, std::vector<Surfel>& all) {
  for (int i = 0; i < count; ++i) all.push_back({{0.8 * i, 0.0, 0.0}, axis.normalized(), group});
}

}  // namespace

TEST_CASE("what holds a scan is counted along the direction that the fewest surfels hold") {
  using Eigen::Vector3d;
  CHECK(fewest_holding({}) == 0.0);
  std::vector<Surfel> ground;
  add(50, Surfel::Group::kNormalZ, Vector3d::UnitZ(), ground);
  CHECK(fewest_holding(ground) == Approx(0.0).margin(1e-9));
  // A rail along x does not hold it along x.
  std::vector<Surfel> road = ground;
  add(20, Surfel::Group::kNormalY, Vector3d::UnitY(), road);
  CHECK(fewest_holding(road) == Approx(0.0).margin(1e-9));
  // Signs across the road do, and so do poles: across themselves, along both x and y.
  std::vector<Surfel> signs = road;
  add(7, Surfel::Group::kNormalX, Vector3d::UnitX(), signs);
  CHECK(fewest_holding(signs) == Approx(7.0));
  std::vector<Surfel> poles = ground;
  add(9, Surfel::Group::kLine, Vector3d::UnitZ(), poles);
  CHECK(fewest_holding(poles) == Approx(9.0));
  // Walls at a right angle that no axis is along: the direction is found, not chosen from three.
  std::vector<Surfel> turned = ground;
  add(8, Surfel::Group::kNormalX, {1.0, 1.0, 0.0}, turned);
  CHECK(fewest_holding(turned) == Approx(0.0).margin(1e-9));
  add(5, Surfel::Group::kNormalY, {-1.0, 1.0, 0.0}, turned);
  CHECK(fewest_holding(turned) == Approx(5.0));
}
