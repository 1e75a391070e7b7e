// SPDX-License-Identifier: MIT
#include "methods/octomap/point_filters.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/methods/octomap/hand_scans.h"

namespace raymoval::octomap_test {
using namespace raymoval::octomap_method;

namespace {

std::size_t count(const Mask& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
}

/// 400 points of a plane through (0, 0, 1) of the given slope along x, no two alike, up to 1 cm off
/// it; then 20 points 0.5 m above it.
[[maybe_unused]] Points slope(double tangent) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-10, 10), off(-0.01, 0.01);
  Points points;
  for (int i = 0; i < 420; ++i) {
    const double x = along(random);
    points.emplace_back(x, along(random), 1.0 + tangent * x + off(random) + (i < 400 ? 0.0 : 0.5));
  }
  return points;
}

}  // namespace

TEST_CASE("a ground plane is refused by a build without PCL, and only by it") {
  const MethodRegistry& methods = MethodRegistry::built_in();
  for (const MethodVariant& variant : methods.find("octomap").variants) {
    INFO(variant.name);
    ConfiguredMethod method = methods.configure("octomap:" + variant.name);
    const bool finds_ground = variant.name == "ground" || variant.name == "ground-noise";
    CHECK(variant.is_available == (kHasPcl || !finds_ground));
    const bool says_so = variant.sentence.find("PCL, which this build lacks") != std::string::npos;
    CHECK(says_so == !variant.is_available);
    if (!finds_ground) CHECK_NOTHROW(method.make());
    set_parameter(method.configuration, "ground", true);
    if (kHasPcl) {
      CHECK_NOTHROW(method.make());
    } else {
      CHECK_THROWS_WITH(method.make(), Catch::Contains("need PCL, and this program was built"));
    }
  }
}

#if RAYMOVAL_PCL
TEST_CASE("the ground is the points near the one plane that is nearly level") {
  const Parameters parameters;
  const Mask ground = find_ground(rounded(slope(0.1)), parameters);  // 0.0997 rad.
  CHECK(count(ground) == 400);
  CHECK(std::all_of(ground.begin(), ground.begin() + 400, [](auto value) { return value == 1; }));
  // 0.197 rad is steeper than 0.15: a level plane through a few points may be found, the slope not.
  CHECK(count(find_ground(rounded(slope(0.2)), parameters)) < 200);
}

#endif

TEST_CASE("noise is far from its neighbours, by the scan's own measure") {
  // Eleven points 1 m apart on a line, and one 9 m away. Mean distance to the two nearest others:
  // 1 inside the line (9 points), 1.5 at its ends, 9.5 for the loner: mean 1.7917, sum of squares
  // 9 + 4.5 + 90.25 = 103.75, variance (103.75 - 21.5^2 / 12) / 11 = 5.930, deviation 2.435. The
  // limit is 4.227 with S = 1, and 9.0966 with S = 3, and 9.583 with S = 3.2.
  Points points;
  for (int i = 0; i < 11; ++i) points.emplace_back(i, 0.0, 0.0);
  points.emplace_back(19.0, 0.0, 0.0);
  Parameters parameters;
  parameters.noise_neighbours = 2;
  Mask expected(12, 0);
  for (const double sigma : {0.1, 1.0, 3.0, 3.2}) {
    parameters.noise_sigma = sigma;
    expected.back() = sigma < 3.1 ? 1 : 0;
    INFO(sigma);
    CHECK(find_noise(rounded(points), parameters, 1) == expected);
  }
}

TEST_CASE("nearest neighbours are those of a comparison of all pairs") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  Points points;
  for (int i = 0; i < 300; ++i) points.emplace_back(normal(random), normal(random), normal(random));
  Parameters parameters;
  parameters.noise_neighbours = 10;
  std::vector<double> mean;
  for (const Eigen::Vector3d& p : points) {
    std::vector<double> distances;
    for (const Eigen::Vector3d& q : points) distances.push_back((p - q).norm());
    std::sort(distances.begin(), distances.end());
    double sum = 0.0;
    for (std::size_t k = 1; k <= 10; ++k) sum += distances[k];
    mean.push_back(sum / 10);
  }
  double sum = 0.0, squares = 0.0;
  for (const double m : mean) sum += m;
  for (const double m : mean) squares += (m - sum / 300) * (m - sum / 300);
  const double limit = sum / 300 + std::sqrt(squares / 299);
  Mask expected;
  for (const double m : mean) expected.push_back(m > limit ? 1 : 0);
  CHECK(find_noise(rounded(points), parameters, 2) == expected);
  CHECK(count(expected) > 5);
}

TEST_CASE("an outlier hits its cell without a beam") {
  HandMap map({});
  map.insert({{2.1, 0.1, 0.1}}, {0.1, 0.1, 0.1}, PointRole::kNoise);
  CHECK(map.log_odds({2.1, 0.1, 0.1}) == Approx(0.847298));
  CHECK_FALSE(map.knows({1.1, 0.1, 0.1}));
}

}  // namespace raymoval::octomap_test
