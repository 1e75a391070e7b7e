// SPDX-License-Identifier: MIT
#include "methods/erasor/polar_bins.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

#include "tests/methods/erasor/scenes.h"

namespace raymoval::erasor_test {
using namespace raymoval::erasor_method;

namespace {

using BodyPoints = std::vector<Eigen::Vector3d>;

BodyPoints quad_and(const std::vector<double>& heights) {
  BodyPoints points = {{2.5, 0.5, 0}, {2.5, 1, 0}, {3.5, 0.5, 0}, {3.5, 1, 0}};
  for (const double z : heights) points.emplace_back(3.0, 0.75, z);
  return points;
}

int count(const Mask& mask) {
  return std::accumulate(mask.begin(), mask.end(), 0);
}

}  // namespace

TEST_CASE("what stands on flat ground is told from it", "[erasor]") {
  // Lowest four: mean 0, so seeds are below 0.5: the road. The plane is z = 0.
  CHECK(find_ground(quad_and({0.6, 1.0, 1.5}), small_grid()) == Mask{1, 1, 1, 1, 0, 0, 0});
}

TEST_CASE("ground is all that lies less than the distance above the plane", "[erasor]") {
  // Once 0.145 joins the four at 0, the plane rises to 0.029 and 0.16 is 0.131 above it: ground
  // from the third round. 0.45 is a seed, but no ground after the first plane (0.15 m or more
  // above).
  BodyPoints points = quad_and({0.145, 0.45});
  CHECK(count(find_ground(points, small_grid())) == 5);
  // However deep below the plane: one-sided. Skipped as the lowest, it seeds no representative.
  Parameters skip_one = small_grid();
  skip_one.lowest_skipped = 1;
  points.emplace_back(2.9, 0.7, -0.9);
  CHECK(find_ground(points, skip_one)[6] == 1);
}

TEST_CASE("the lowest points are skipped as outliers", "[erasor]") {
  // A ghost at -0.4 below the road. As the lowest point it would leave itself as the only seed
  // (-0.4 + 0.3 = -0.1), a plane at -0.4, and all of the road above it. Skipped, the road seeds the
  // plane with it: z = -0.08 (variance 0.026 along z, 0.05 along y), 0.08 m below the road.
  BodyPoints points = quad_and({-0.4, 0.6});
  Parameters parameters = small_grid();
  parameters.lowest_averaged = 1;
  parameters.seed_height = 0.3;
  CHECK(find_ground(points, parameters) == Mask{0, 0, 0, 0, 1, 0});
  parameters.lowest_skipped = 1;
  CHECK(find_ground(points, parameters) == Mask{1, 1, 1, 1, 1, 0});
}

TEST_CASE("a pole without ground stays whole", "[erasor]") {
  // Eleven points within 2 cm of a vertical: lowest four mean 0.675, the seeds below 1.175 lie on
  // the pole, their plane is vertical and every point is within 0.15 m of it.
  BodyPoints pole;
  for (int i = 0; i < 11; ++i) {
    pole.emplace_back(3.0 + 0.01 * (i % 3), 0.75 + 0.01 * (i % 2), 0.3 + 0.25 * i);
  }
  CHECK(count(find_ground(pole, small_grid())) == 11);
}

TEST_CASE("skipping more points than the road has turns the plane", "[erasor]") {
  // Scene of 4 road points and a car with 5 points skipped: representative (1.0 + 1.5) / 2, all
  // points are seeds, the least spread is along y (0.054 m2 against 0.14 along x and 0.36 along z):
  // a vertical plane near y = 0.75. The car is on it.
  Parameters parameters = small_grid();
  parameters.lowest_skipped = 5;
  const Mask ground = find_ground(quad_and({0.6, 1.0, 1.5}), parameters);
  CHECK(ground == Mask{1, 0, 1, 0, 1, 1, 1});
}

TEST_CASE("a bin with fewer points than are skipped starts from its lowest point", "[erasor]") {
  // On a hill: road at 2.0, a car above. Seeds below 2.5.
  BodyPoints points = quad_and({0.6});
  for (Eigen::Vector3d& point : points) point.z() += 2.0;
  Parameters parameters = small_grid();
  parameters.lowest_skipped = 5;
  CHECK(find_ground(points, parameters) == Mask{1, 1, 1, 1, 0});
}

TEST_CASE("no points, no ground to find", "[erasor]") {
  CHECK(find_ground({}, small_grid()).empty());
}

}  // namespace raymoval::erasor_test
