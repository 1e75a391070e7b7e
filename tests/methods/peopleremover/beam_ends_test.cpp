// SPDX-License-Identifier: MIT
#include "methods/peopleremover/beams.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

namespace raymoval::peopleremover_test {
using namespace raymoval::peopleremover_method;

namespace {

using Points = std::vector<Eigen::Vector3d>;

std::vector<double> lengths(const Points& points, double voxel_size) {
  Parameters parameters;
  parameters.voxel_size = voxel_size;
  return BeamEnds(parameters).find(points);
}

/// The same by the letter of the description: every point against every other.
std::vector<double> slow_lengths(const Points& points, double voxel_size) {
  const double diagonal = std::sqrt(3.0) * voxel_size;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].norm() < points[b].norm();
  });
  std::vector<double> m(points.size(), kWholeBeam);
  for (const std::size_t j : order) {
    if (m[j] != kWholeBeam) continue;
    const double r = points[j].norm();
    const Eigen::Vector3d u = points[j] / r;
    if (r <= 2.0 * diagonal) {
      m[j] = 0.0;
      continue;
    }
    const double angle = 2.0 * std::asin(diagonal / (r - diagonal));
    std::vector<std::size_t> near;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double cosine = u.dot(points[k].normalized());
      if (k == j || cosine >= 1.0 || std::acos(cosine) < angle) near.push_back(k);
    }
    for (const std::size_t k : near) mean += points[k] / static_cast<double>(near.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const std::size_t k : near) {
      covariance += (points[k] - mean) * (points[k] - mean).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    Eigen::Vector3d n = solver.eigenvectors().col(0);
    if (near.size() < 3 || solver.eigenvalues()[1] < 1e-9 * solver.eigenvalues()[2]) n = -u;
    if (n.dot(u) >= 0.0) n = -n;
    const double plane = points[j].dot(n) + diagonal;
    m[j] = std::clamp(plane / u.dot(n), 0.0, r);
    for (const std::size_t k : near) {
      const double d = plane / points[k].normalized().dot(n);
      if (d <= points[k].norm()) m[k] = std::min(m[k], std::max(0.0, d));
    }
  }
  return m;
}

/// Rings on flat ground `height` below the sensor, at these horizontal distances.
Points ground(double height, const std::vector<double>& distances) {
  Points points;
  for (const double distance : distances) {
    for (int k = 0; k < 720; ++k) {
      const double azimuth = (k + 0.5) / 360.0 * 3.14159265358979;
      points.emplace_back(distance * std::cos(azimuth), distance * std::sin(azimuth), -height);
    }
  }
  return points;
}

}  // namespace

TEST_CASE("beams to flat ground end one voxel diagonal above it", "[peopleremover]") {
  // Height 1.73 m, voxels of 0.2 m: 1 - 0.3464 / 1.73 = 0.79976 of the way, for any ring at any
  // distance from the next, as long as a neighbourhood has more than one ring.
  std::vector<double> distances;
  for (double d = 4.0; d < 42.0; d *= 1.008) distances.push_back(d);
  const Points points = ground(1.73, distances);
  const std::vector<double> m = lengths(points, 0.2);
  for (std::size_t k = 0; k < points.size(); ++k) {
    REQUIRE(m[k] / points[k].norm() == Approx(1.0 - 0.2 * std::sqrt(3.0) / 1.73).epsilon(1e-6));
  }
}

TEST_CASE("beam ends are those of a search through all points", "[peopleremover]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  const auto scene = GENERATE(0, 1, 2, 3);
  Points points;
  for (int k = 0; k < 600; ++k) {
    const double x = side(random), y = side(random), z = side(random);
    if (scene == 0) points.emplace_back(15 * x, 15 * y, 15 * z);           // All around.
    if (scene == 1) points.emplace_back(10 * x, 10 * y, -1.5 + 0.02 * z);  // Ground.
    if (scene == 2) points.emplace_back(0.8 * x, 0.8 * y, 5 + 0.1 * z);    // Around the pole.
    if (scene == 3) points.emplace_back(-6 + 0.05 * x, 0.7 * y, 2 * z);  // Where the azimuth wraps.
  }
  std::erase_if(points, [](const auto& p) { return p.norm() < 0.4; });
  const std::vector<double> fast = lengths(points, 0.2), slow = slow_lengths(points, 0.2);
  INFO("scene " << scene);
  for (std::size_t k = 0; k < points.size(); ++k) {
    REQUIRE(fast[k] == Approx(slow[k]).epsilon(1e-7));
    REQUIRE(fast[k] >= 0.0);
    REQUIRE(fast[k] <= points[k].norm());
  }
}

TEST_CASE("surface normals", "[peopleremover]") {
  // A plane whose points scatter equally both ways, a line, a point.
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, -3).normalized();
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  CHECK(std::abs(surface_normal(plane * 1e-6).dot(normal)) == Approx(1.0).epsilon(1e-9));
  CHECK(surface_normal(normal * normal.transpose()).isZero());
  CHECK(surface_normal(Eigen::Matrix3d::Zero()).isZero());
}

}  // namespace raymoval::peopleremover_test
