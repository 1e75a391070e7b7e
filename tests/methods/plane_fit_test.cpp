// SPDX-License-Identifier: MIT
#include "methods/common/plane_fit.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace raymoval;

namespace {

using Points = std::vector<Eigen::Vector3d>;

}  // namespace

TEST_CASE("one point, two points and a line have an upright plane", "[plane]") {
  CHECK(fit_plane(Points{{3, 1, 0.5}}, Mask{1}).plane.normal.z() == Approx(1.0));
  const Plane level = fit_plane(Points{{3, 1, 0.5}, {4, 2, 0.5}}, Mask{1, 1}).plane;
  CHECK(level.normal.z() == Approx(1.0));
  CHECK(level.height_of({9, 9, 0.7}) == Approx(0.2));
  // A line that climbs 1 in 2: the most upright plane through it climbs with it.
  const Plane ramp = fit_plane(Points{{0, 0, 0}, {1, 0, 0.5}, {2, 0, 1}}, Mask{1, 1, 1}).plane;
  CHECK(ramp.normal.z() == Approx(2.0 / std::sqrt(5.0)));
  CHECK(ramp.height_of({1, 5, 0.5}) == Approx(0.0).margin(1e-12));
  // A vertical line is on its plane for any direction of the plane.
  const Plane wall = fit_plane(Points{{3, 1, 0}, {3, 1, 1}, {3, 1, 2}}, Mask{1, 1, 1}).plane;
  CHECK(wall.height_of({3, 1, 7}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("a plane is recovered from random points and points up", "[plane]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    const Eigen::Vector3d normal =
        Eigen::Vector3d(uniform(random), uniform(random), 1.0 + uniform(random)).normalized();
    const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    const Eigen::Vector3d origin(30 * uniform(random), 30 * uniform(random), uniform(random));
    Points points;
    for (int i = 0; i < 20; ++i)
      points.push_back(origin + uniform(random) * u + 2 * uniform(random) * v);
    const Plane plane = fit_plane(points, Mask(points.size(), 1)).plane;
    CHECK((plane.normal - normal).norm() < 1e-9);
    CHECK(std::abs(plane.height_of(origin)) < 1e-9);
    // The order of the points does not matter.
    std::reverse(points.begin(), points.end());
    CHECK((fit_plane(points, Mask(points.size(), 1)).plane.normal - normal).norm() < 1e-9);
  }
}

TEST_CASE("a fit tells the points' mean and variances", "[plane]") {
  // Along x: 0, 4 twice each (variance 4), along y: 0, 2 (variance 1), level.
  const PlaneFit fit =
      fit_plane(Points{{0, 0, 1}, {4, 0, 1}, {0, 2, 1}, {4, 2, 1}, {9, 9, 9}}, Mask{1, 1, 1, 1, 0});
  CHECK((fit.centre - Eigen::Vector3d(2, 1, 1)).norm() < 1e-12);
  CHECK((fit.variances - Eigen::Vector3d(0, 1, 4)).norm() < 1e-12);
  CHECK(fit.points == 4.0);
}
