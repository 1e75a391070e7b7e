// SPDX-License-Identifier: MIT
#include "methods/common/range_adaptive_clusters.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/scan/voxel_key.h"
#include "methods/common/disjoint_sets.h"

using namespace raymoval;

namespace {

/// Components of the graph of all pairs within reach, and of pairs that share a cell.
template <class Scalar>
std::vector<int> slow_clusters(const std::vector<Eigen::Vector3<Scalar>>& points,
                               const std::vector<Scalar>& ranges, Scalar gap, Scalar growth) {
  std::vector<int> number(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) number[i] = static_cast<int>(i);
  const double scale = std::sqrt(Scalar{3}) / gap;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        const Scalar reach = gap + growth * std::min(ranges[i], ranges[j]);
        const bool same_cell = voxel_index(points[i].template cast<double>(), scale) ==
                               voxel_index(points[j].template cast<double>(), scale);
        if ((points[i] - points[j]).squaredNorm() > reach * reach && !same_cell) continue;
        if (number[i] <= number[j]) continue;
        number[i] = number[j];
        changed = true;
      }
    }
  }
  std::vector<int> order(points.size(), -1);
  int next = 0;
  for (int& n : number) {
    int& renamed = order[static_cast<std::size_t>(n)];
    if (renamed < 0) renamed = next++;
    n = renamed;
  }
  return number;
}

}  // namespace

TEST_CASE("range-adaptive clusters in single precision are those of all pairs") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> at(-4.0F, 4.0F);
  for (int round = 0; round < 20; ++round) {
    std::vector<Eigen::Vector3f> points;
    std::vector<float> ranges;
    for (int i = 0; i < 150; ++i) {
      points.emplace_back(at(random), at(random), 0.2F * at(random));
      ranges.push_back(points.back().norm() + 3.0F * static_cast<float>(round));
    }
    CHECK(range_adaptive_clusters(points, ranges, 0.3F, 0.01F) ==
          slow_clusters(points, ranges, 0.3F, 0.01F));
  }
  CHECK(range_adaptive_clusters({}, {}, 0.3F, 0.01F).empty());
}

TEST_CASE("range-adaptive clusters of things that stand above each other are those of all pairs") {
  // Poles of 8 m: cells right above each other that touch, that do not, and empty ones between.
  std::mt19937 random(17);
  std::uniform_real_distribution<float> aside(-0.5F, 0.5F), up(-4.0F, 4.0F);
  for (int round = 0; round < 20; ++round) {
    std::vector<Eigen::Vector3f> points;
    std::vector<float> ranges;
    for (int i = 0; i < 150; ++i) {
      const auto pole = static_cast<float>(i % 4);
      points.emplace_back(pole + 0.3F * aside(random), 0.2F * aside(random), up(random));
      ranges.push_back(points.back().norm() + 2.0F * static_cast<float>(round));
    }
    CHECK(range_adaptive_clusters(points, ranges, 0.3F, 0.01F) ==
          slow_clusters(points, ranges, 0.3F, 0.01F));
  }
}

TEST_CASE("range-adaptive clusters: the same gap joins far away and not nearby") {
  // Reach 0.3 + 0.02 r: 0.5 m at 10 m, 0.9 m at 30 m.
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {0.7, 0, 0}, {3, 0, 0}};
  CHECK(range_adaptive_clusters(points, {10, 10, 10}, 0.3, 0.02) == std::vector<int>{0, 1, 2});
  CHECK(range_adaptive_clusters(points, {30, 30, 30}, 0.3, 0.02) == std::vector<int>{0, 0, 1});
  // The smaller range of a pair decides.
  CHECK(range_adaptive_clusters(points, {10, 30, 30}, 0.3, 0.02) == std::vector<int>{0, 1, 2});
  CHECK(range_adaptive_clusters({}, {}, 0.3, 0.02).empty());
}

TEST_CASE("disjoint sets are numbered by their first elements") {
  DisjointSets sets(5);
  sets.join(4, 1);
  sets.join(3, 4);
  CHECK(sets.numbers() == std::vector<int>{0, 1, 2, 1, 1});
  CHECK(sets.root(3) == 1);
}
