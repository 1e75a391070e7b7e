// SPDX-License-Identifier: MIT
#include "methods/removert/map_points.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tuple>

#include "core/error.h"
#include "tests/methods/removert/point_world.h"

namespace raymoval::removert_test {
using namespace raymoval::removert_method;

namespace {

MapPoints map_of(const CellLattice& lattice, const std::vector<Points>& scans) {
  MapBuilder builder(lattice);
  for (const Points& points : scans) builder.add(points, Pose::Identity(), 1);
  return builder.finish();
}

std::vector<Eigen::Vector3d> positions(const MapPoints& map) {
  std::vector<Eigen::Vector3d> all;
  for (const Block& block : map.blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) all.push_back(map.position(block, i));
  }
  return all;
}

Points random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(place(random), place(random), place(random));
  return points;
}

}  // namespace

TEST_CASE("removert: centroids are those of a plain table of cells") {
  const CellLattice lattice(0.2);
  const std::vector<Points> scans = {random_points(5000, 1), random_points(5000, 2)};
  std::map<std::tuple<int, int, int>, std::pair<Eigen::Vector3d, double>> expected;
  for (const Points& points : scans) {
    for (const Eigen::Vector3f& point : points) {
      const auto cell = [&](int axis) {
        return static_cast<int>(std::floor(static_cast<double>(point[axis]) / 0.2));
      };
      auto& [sum, count] =
          expected.try_emplace({cell(0), cell(1), cell(2)}, Eigen::Vector3d::Zero(), 0.0)
              .first->second;
      sum += point.cast<double>();
      count += 1.0;
    }
  }
  const MapPoints map = map_of(lattice, scans);
  REQUIRE(map.size() == expected.size());
  for (const Block& block : map.blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const VoxelIndex index = lattice.cell_index(block.key, map.id[i]);
      const auto& [sum, count] = expected.at({index.x(), index.y(), index.z()});
      CHECK((map.position(block, i) - sum / count).norm() < 1e-6);
    }
  }
}

TEST_CASE("removert: marked points are those of the map, in its order") {
  const MapPoints map = map_of(CellLattice(0.05), {random_points(3000, 4)});
  Mask marks(map.size());
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = i % 3 == 0 || i < 200 ? 1 : 0;
  const auto all = positions(map);
  for (const std::uint8_t mark : {0, 1}) {
    std::vector<Eigen::Vector3d> expected;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (marks[i] == mark) expected.push_back(all[i]);
    }
    CHECK(positions(marked_points(map, marks, mark)) == expected);
  }
}

TEST_CASE("removert: balls hold their points") {
  const MapPoints map = map_of(CellLattice(0.05), {random_points(3000, 5)});
  REQUIRE_FALSE(map.groups.empty());
  std::size_t seen = 0;
  for (const BlockGroup& group : map.groups) {
    for (std::size_t b = group.begin; b < group.end; ++b) {
      const Block& block = map.blocks[b];
      for (std::size_t i = block.begin; i < block.end; ++i, ++seen) {
        const Eigen::Vector3d at = map.position(block, i);
        CHECK((at - block.ball.centre).norm() <= static_cast<double>(block.ball.radius));
        CHECK((at - group.ball.centre).norm() <= static_cast<double>(group.ball.radius));
      }
    }
  }
  CHECK(seen == map.size());
}

TEST_CASE("removert: a point beyond the lattice is an error") {
  const CellLattice lattice(0.05);
  MapBuilder builder(lattice);
  CHECK_THROWS_AS(builder.add({{1e7F, 0, 0}}, Pose::Identity(), 1), DataError);
}

}  // namespace raymoval::removert_test
